// Frames by the numbers in a file, or in the names of a folder's files.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/scratch_folder.hpp"
#include "formats/frame_numbers.hpp"
#include "formats/layout_samples.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using Numbers = std::vector<std::optional<long long>>;

const LayoutSample& sample_called(const std::string& name) {
  return *std::ranges::find(layout_samples(), name, &LayoutSample::name);
}

/// A folder of files of these names.
std::filesystem::path folder_of(const std::string& sample, const ScratchFolder& folder,
                                const std::string& name, const std::vector<std::string>& files) {
  std::filesystem::create_directory(folder / name);
  for (const std::string& file : files)
    std::ofstream(folder / name / file) << sample_called(sample).text;
  return folder / name;
}

std::filesystem::path openpose_folder(const ScratchFolder& folder, const std::string& name,
                                      const std::vector<std::string>& files) {
  return folder_of("frame_0007_keypoints.json", folder, name, files);
}

bool reports(const TrackReading& reading, const std::string& what) {
  return std::ranges::any_of(reading.notices, [&](const std::string& notice) {
    return notice.find(what) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("frame numbers: the last group of digits that is different in each name") {
  CHECK(frame_numbers({"input_000000000007_keypoints"}) == Numbers{7});
  CHECK(frame_numbers({"cam01.0007", "cam01.0008"}) == Numbers{7, 8});
  CHECK(frame_numbers({"cam1_003_v2", "cam1_004_v2"}) == Numbers{3, 4});
  CHECK(frame_numbers({"3", "no number"}) == Numbers{3, std::nullopt});
  CHECK(frame_numbers({"99999999999999999999"}) == Numbers{std::nullopt});
}

TEST_CASE("frame numbers: times are in their order across the seconds") {
  CHECK(frame_numbers({"1699999999.967", "1700000000.001"}) == Numbers{0, 1});
  CHECK(are_times({"1699999999.967", "1700000000.001"}));
  // Fractions of any length, hours with microseconds behind them, the same fractions every second.
  CHECK(frame_numbers({"9.5", "10.12", "9.75", "front"}) == Numbers{0, 2, 1, std::nullopt});
  CHECK(frame_numbers({"20261128_143059_970000", "20261128_143058_940000", "20261128_143059_003333",
                       "20261128_143058_970000", "20261128_143100_003333"}) ==
        Numbers{3, 0, 2, 1, 4});
  CHECK(frame_numbers({"7.25", "7.50", "7.75", "8.00", "8.25", "8.50"}) ==
        Numbers{0, 1, 2, 3, 4, 5});
  // A camera and a frame, a fraction without its zeros, one second alone: no times.
  CHECK(frame_numbers({"cam1.0001", "cam1.0002", "cam1.0003", "cam2.0001"}) == Numbers{1, 2, 3, 1});
  CHECK(frame_numbers({"7_95", "8_1", "8_25"}) == Numbers{95, 1, 25});
  CHECK(frame_numbers({"7.950", "7.970"}) == Numbers{950, 970});
  CHECK(!are_times({"7.950", "7.970"}));
}

TEST_CASE("frame numbers: a folder's files that are named by time are frames one after the other") {
  const ScratchFolder folder;
  const TrackReading reading = read_tracks(
      openpose_folder(folder, "times",
                      {"1699999999.900.json", "1699999999.933.json", "1699999999.967.json",
                       "1700000000.000.json", "1700000000.033.json", "1700000000.067.json"}));
  CHECK(reading.frame_numbers == std::vector<long long>{0, 1, 2, 3, 4, 5});
  CHECK((reading.people.front().confidence.rowwise().maxCoeff().array() > 0).all());
  CHECK(reports(reading, "named by time"));
  CHECK_THROWS_WITH_AS(
      read_track(openpose_folder(folder, "cameras",
                                 {"cam1.0001.json", "cam1.0002.json", "cam2.0001.json"})),
      doctest::Contains("a second file of frame 1"), InputError);
}

TEST_CASE("frame numbers: gaps are missing joints, steps are none") {
  const ScratchFolder folder;
  const TrackReading gap =
      read_tracks(openpose_folder(folder, "gap", {"f_003.json", "f_004.json", "f_006.json"}));
  CHECK(gap.frame_numbers == std::vector<long long>{3, 4, 5, 6});
  REQUIRE(gap.people.front().frames() == 4);
  CHECK((gap.people.front().confidence.row(2).array() == 0).all());
  CHECK((gap.people.front().confidence.row(3).array() > 0).any());

  const TrackReading steps =
      read_tracks(openpose_folder(folder, "steps", {"f_000.json", "f_005.json", "f_010.json"}));
  CHECK(steps.people.front().frames() == 3);
  CHECK(steps.frame_numbers == std::vector<long long>{0, 5, 10});
  CHECK(reports(steps, "steps of 5"));

  const TrackReading images = read_tracks(
      openpose_folder(folder, "images", {"f_000785.json", "f_040083.json", "f_196141.json"}));
  CHECK(images.people.front().frames() == 3);
  CHECK(images.frame_numbers == std::vector<long long>{785, 40083, 196141});
  CHECK(reports(images, "one after the other"));
}

TEST_CASE("frame numbers: names that have none are left out with a notice, doubles refused") {
  const ScratchFolder folder;
  for (const std::string sample : {"frame_0007_keypoints.json", "mmpose_image.json"}) {
    CAPTURE(sample);
    const TrackReading odd = read_tracks(
        folder_of(sample, folder, "odd_" + sample, {"f_1.json", "f_2.json", "front.json"}));
    CHECK(odd.people.front().frames() == 2);
    CHECK(reports(odd, "front.json has no frame number"));
    const TrackReading none =
        read_tracks(folder_of(sample, folder, "none_" + sample, {"a.json", "b.json"}));
    CHECK(none.people.front().frames() == 2);
    const auto doubles =
        folder_of(sample, folder, "doubles_" + sample, {"a_1.json", "b_1.json", "b_2.json"});
    CHECK_THROWS_WITH_AS(read_track(doubles), doctest::Contains("a second file of frame 1"),
                         InputError);
  }
  CHECK_THROWS_WITH_AS(read_track(openpose_folder(folder, "empty", {})),
                       doctest::Contains("no .json files"), InputError);
}

TEST_CASE("frame numbers: a folder's format is that of its frames, not of other files among them") {
  const ScratchFolder folder;
  for (const std::string sample : {"frame_0007_keypoints.json", "mmpose_image.json"})
    for (const char* content : {R"({"fps": 30})", "words"}) {
      CAPTURE(sample);
      CAPTURE(content);
      const auto frames = folder_of(sample, folder, "frames", {"f_1.json", "f_2.json"});
      std::ofstream(frames / "a_notes.json") << content;
      const TrackReading reading = read_tracks(frames);
      CHECK(reading.format == sample_called(sample).format);
      CHECK(reading.people.front().frames() == 2);
      CHECK(reports(reading, "a_notes.json has no frame number and is left out"));
    }
}

TEST_CASE("COCO's flags: visible, hidden and not labelled") {
  const ScratchFolder folder;
  const LayoutSample& sample = sample_called("annotations.json");
  const TrackReading reading = read_tracks(folder.write(sample.name, sample.text));
  const Track2d& track = reading.people.front();
  CHECK(track.confidence(0, 0) == 1);
  CHECK(track.confidence(0, 1) == 0.5);
  CHECK(track.width_px == 1280);
  CHECK(reports(reading, "visibility flags"));
}

TEST_CASE("confidences a little beyond 1 are cut, not scaled") {
  const ScratchFolder folder;
  const LayoutSample& sample = sample_called("mmpose_video.json");
  const TrackReading reading = read_tracks(folder.write(sample.name, sample.text));
  CHECK((reading.people.front().confidence.array() == 1).all());
  CHECK(reports(reading, "are cut at 1"));
}
