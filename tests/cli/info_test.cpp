// The numbers of frames that `info` and `regenerate` print are the file's own.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "base/scratch_folder.hpp"
#include "run_cli.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;

namespace {

/// COCO's list of one person in the images of these numbers, who is elsewhere from `jump` on.
std::string person_in_images(const std::vector<long long>& images, long long jump) {
  json entries = json::array();
  for (const long long image : images) {
    std::vector<double> numbers;
    for (int joint = 0; joint < 17; ++joint)
      numbers.insert(numbers.end(),
                     {(image < jump ? 200.0 : 1200.0) + 40 * (joint % 2), 100.0 + 20 * joint, 0.9});
    entries.push_back(
        {{"image_id", image}, {"category_id", 1}, {"keypoints", numbers}, {"track_id", 1}});
  }
  return entries.dump();
}

json described_person(const std::vector<long long>& images, long long jump) {
  const ScratchFolder folder;
  const auto track = folder.write("track.json", person_in_images(images, jump));
  const CliResult result = run_cli(fmt::format("info --json '{}'", track.string()));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const json people = json::parse(result.standard_output).at("people");
  REQUIRE(people.size() == 1);
  return people[0];
}

}  // namespace

TEST_CASE("info: frames have the file's own numbers, in steps, with gaps and far apart") {
  std::vector<long long> steps;
  for (long long number = 100; number <= 195; number += 5) steps.push_back(number);
  const json in_steps = described_person(steps, 150);
  CHECK(in_steps.at("seen_frames") == 20);
  CHECK(in_steps.at("first_frame") == 100);
  CHECK(in_steps.at("last_frame") == 195);
  CHECK(in_steps.at("jumps_to_frames") == json{150});

  const json gap = described_person({3, 4, 6}, 100);
  CHECK(gap.at("first_frame") == 3);
  CHECK(gap.at("last_frame") == 6);
  CHECK(gap.at("longest_gap_frames") == 1);

  const json sparse = described_person({785, 40083, 196141}, 1'000'000);
  CHECK(sparse.at("first_frame") == 785);
  CHECK(sparse.at("last_frame") == 196141);
  CHECK(sparse.at("jumps_to_frames").empty());
}

TEST_CASE("regenerate: messages number frames as the file does") {
  if (!have_device()) return;
  const ScratchFolder folder;
  std::vector<long long> images;
  for (long long image = 431; image < 471; ++image)
    if (image < 440 || image > 445) images.push_back(image);
  const auto track = folder.write("track.json", person_in_images(images, 460));
  const CliResult result =
      run_cli(fmt::format("regenerate --fit none --image-size 1920 1080 --input '{}' -o '{}'",
                          track.string(), (folder / "out.bvh").string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_error.find("nobody is seen in frames 440-445:") != std::string::npos);
  CHECK(result.standard_error.find("frames 431-459, 460-470 are") != std::string::npos);
}
