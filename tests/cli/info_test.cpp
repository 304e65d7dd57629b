// The numbers of frames that `info` and `regenerate` print are the file's own.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/scratch_folder.hpp"
#include "fitted_machines.hpp"
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

TEST_CASE("info: of a machine, the settings that it has, a line each") {
  if (!have_device()) return;
  const auto lines_of = [](const char* kind) {
    const CliResult result =
        run_cli(fmt::format("info '{}'", FittedMachines::instance().model(kind)));
    CHECK(result.exit_code == 0);
    return result.standard_output;
  };
  const auto check = [](const std::string& text, const std::vector<std::string>& settings,
                        const std::vector<std::string>& others) {
    CAPTURE(text);
    CHECK(("\n" + text).find("\nconfig\n") != std::string::npos);
    for (const std::string& setting : settings)
      CHECK_MESSAGE(text.find("\n  " + setting + " ") != std::string::npos, setting);
    for (const std::string& setting : others)
      CHECK_MESSAGE(text.find("\n  " + setting) == std::string::npos, setting);
  };
  check(lines_of("rbm"), {"binary.rate", "batch", "hidden", "machine"},
        {"binary.rate-A", "binary.rate-B", "binary.history-noise", "binary.deviation-rate",
         "gaussian.", "mrbm.", "order", "layers"});
  check(lines_of("gaussian-rbm"), {"gaussian.rate", "gaussian.deviation-rate"},
        {"gaussian.rate-A", "binary.", "mrbm.", "order", "layers"});
  check(lines_of("crbm"), {"gaussian.rate", "gaussian.rate-A", "gaussian.history-noise", "order"},
        {"gaussian.deviation-rate", "binary.", "mrbm.", "layers"});
  check(lines_of("cdbn"), {"gaussian.rate-A", "binary.rate-A", "order", "layers"}, {"mrbm."});
}

TEST_CASE("info: trained parameters are counted, and nothing else") {
  if (!have_device()) return;
  // 5 visible and 5 hidden units; --standardize keeps a scale, which is not learnt.
  for (const char* kind : {"rbm", "gaussian-rbm"}) {
    const CliResult result =
        run_cli(fmt::format("info --json '{}'", FittedMachines::instance().model(kind)));
    CHECK(json::parse(result.standard_output).at("parameters") == 5 * 5 + 5 + 5);
  }
}

TEST_CASE("info: a folder that holds no track, with what to give in its place") {
  const ScratchFolder folder;
  const auto check_refused = [](const std::filesystem::path& path, const std::string& words) {
    const CliResult result = run_cli(fmt::format("info '{}'", path.string()));
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 3);
    CHECK(result.standard_error.find(path.string() + ": " + words) != std::string::npos);
  };
  std::filesystem::create_directories(folder / "run 1/unfinished");
  folder.write("run 1/model.safetensors", "");
  const auto run = folder / "run 1";
  check_refused(run,
                "the folder of a training; its model is " + run.string() + "/model.safetensors");
  std::filesystem::create_directories(folder / "clips/walks");
  check_refused(folder / "clips", "no .json files in this folder");
  folder.write("clips/walks/a.bvh", small_bvh(3));
  check_refused(folder / "clips",
                fmt::format("a folder of clips; `mcdbn-cl corpus {}` describes them",
                            (folder / "clips").string()));
}

TEST_CASE("info: a file of another use is refused with what it is for") {
  const ScratchFolder folder;
  const auto refusal_of = [&](const std::string& name, const std::string& text) {
    const auto path = folder.write(name, text);
    const CliResult result = run_cli(fmt::format("info '{}'", path.string()));
    CHECK(result.exit_code == 3);
    CHECK(result.standard_error.find(path.string() + ": ") != std::string::npos);
    return result.standard_error;
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    return text.find(part) != std::string::npos;
  };
  CHECK(contains(refusal_of("data.csv", "0.5,1,0\n1,0,0.25\n"),
                 "it is a matrix of 2 x 3 numbers, for `mcdbn-cl fit`"));
  CHECK_FALSE(contains(refusal_of("words.csv", "a,b\nc,d\n"), "matrix"));
  CHECK(contains(refusal_of("rbm.metrics.jsonl", "{\"stage\":\"layer.0\"}\n{\"stage\":\"x\"}\n"),
                 "it is the log of a training"));
  CHECK(contains(refusal_of("corpus.toml", "[[clip]]\npath = \"a.bvh\"\n"),
                 "a list of clips is for `mcdbn-cl train`"));
}

TEST_CASE("info: a flat array of NumPy is reported as what it may be as well") {
  const ScratchFolder folder;
  const auto notices_of = [&](const std::string& shape) {
    std::string header =
        fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}), }}", shape);
    header.resize(117, ' ');
    header += '\n';
    std::string file = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header;
    for (int i = 0; i < 12 * 34; ++i) {
      const auto value = static_cast<float>(100 + 7 * (i % 34));
      file.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    const auto path = folder.write("track.npy", file);
    const CliResult result = run_cli(fmt::format("info --json '{}'", path.string()));
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return json::parse(result.standard_output).at("notices").dump();
  };
  CHECK(notices_of("12, 34").find("a matrix of 12 x 34 numbers, read as a frame a row") !=
        std::string::npos);
  CHECK(notices_of("12, 17, 2").find("matrix") == std::string::npos);
}

TEST_CASE("regenerate: messages number frames as the file does") {
  if (!have_device()) return;
  const ScratchFolder folder;
  std::vector<long long> images;
  for (long long image = 431; image < 471; ++image)
    if (image < 440 || image > 446) images.push_back(image);
  const auto track = folder.write("track.json", person_in_images(images, 460));
  const CliResult result =
      run_cli(fmt::format("regenerate --fit none --image-size 1920 1080 --input '{}' -o '{}'",
                          track.string(), (folder / "out.bvh").string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_error.find("nobody is seen in frames 440-446:") != std::string::npos);
  CHECK(result.standard_error.find("frames 431-459, 460-470 are") != std::string::npos);
}
