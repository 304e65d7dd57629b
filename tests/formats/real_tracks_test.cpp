// Every 2D track of the shared data is read, and is what its README describes.
#include "mcdbn/formats/track_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "base/capture_bound.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "formats/csv_table.hpp"
#include "mcdbn/base/errors.hpp"
#include "shared_data.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct RealTrack {
  std::string path, format, joint_set;
  int joints, frames, people;
};

const std::vector<RealTrack>& real_tracks() {
  static const std::vector<RealTrack> tracks{
      {"formats/openpose_body25_single", "openpose", "BODY_25", 25, 40, 1},
      {"formats/openpose_coco18_tfpose", "openpose", "COCO_18", 18, 1, 1},
      {"formats/rtmpose_halpe26_openposejson", "openpose", "HALPE_26", 26, 20, 1},
      {"pose2d/openpose-treadmill/27", "openpose", "BODY_25", 25, 90, 2},
      {"pose2d/openpose-treadmill/32", "openpose", "BODY_25", 25, 90, 2},
      {"pose2d/openpose-treadmill/95", "openpose", "BODY_25", 25, 90, 1},
      {"pose2d/S00_P00_SingleParticipant/S00_P00_T01_BalancingTrial/pose/cam01_json", "openpose",
       "BODY_25B", 25, 100, 2},
      {"pose2d/S00_P00_SingleParticipant/S00_P00_T01_BalancingTrial/pose/cam02_json", "openpose",
       "BODY_25B", 25, 100, 2},
      {"pose2d/S00_P00_SingleParticipant/S00_P00_T01_BalancingTrial/pose/cam03_json", "openpose",
       "BODY_25B", 25, 100, 1},
      {"pose2d/S00_P00_SingleParticipant/S00_P00_T01_BalancingTrial/pose/cam04_json", "openpose",
       "BODY_25B", 25, 100, 1},
      {"pose2d/S00_P00_SingleParticipant/S00_P00_T00_StaticTrial/pose/cam01_json", "openpose",
       "BODY_25B", 25, 12, 1},
      {"formats/coco17_annotation/test_coco.json", "coco", "COCO_17", 17, 4, 6},
      {"formats/coco17_results/person_keypoints_val2014_fakekeypoints100_results.json", "coco",
       "COCO_17", 17, 47, 11},
      {"formats/alphapose_halpe26/alphapose-results_first60.json", "alphapose", "HALPE_26", 26, 60,
       1},
      {"formats/alphapose_halpe26/alphapose-results_multi_60frames.json", "alphapose", "HALPE_26",
       26, 60, 3},
      {"formats/blazepose_json/pose_squats.full.json", "mediapipe", "MEDIAPIPE_33", 33, 65, 1},
      {"formats/movenet_json/pose_1.json", "mediapipe", "COCO_17", 17, 120, 1},
      {"formats/deeplabcut/mouse_single.csv", "deeplabcut", "", 8, 11, 1},
      {"formats/deeplabcut/wasp_single.csv", "deeplabcut", "", 2, 11, 1},
      {"formats/deeplabcut/mouse_multi.csv", "deeplabcut", "", 12, 27, 2},
      {"formats/deeplabcut/maudlc_labels_testdata.csv", "deeplabcut", "", 5, 4, 3},
      {"formats/lightningpose/mouse_single.csv", "deeplabcut", "", 12, 11, 1},
      {"formats/sleap_csv/SLEAP_two-flies_sleap-io.analysis_rows.csv", "sleap", "", 13, 2, 2},
      {"pose2d/sports2d-demo/mediapipe_pose_full.csv", "csv", "MEDIAPIPE_33", 33, 230, 1},
      {"pose2d/sports2d-demo/mediapipe_walker.csv", "csv", "MEDIAPIPE_33", 33, 230, 1},
  };
  return tracks;
}

}  // namespace

TEST_CASE("real tracks: every file is recognised and read as what it is") {
  for (const RealTrack& real : real_tracks()) {
    CAPTURE(real.path);
    if (!have_shared_data(real.path, "real tracks")) continue;
    const TrackReading reading = read_tracks(shared_data() / real.path, {.person = "all"});
    for (const std::string& notice : reading.notices) INFO(notice);
    CHECK(reading.format == real.format);
    CHECK(reading.joint_set == real.joint_set);
    CHECK(reading.people_seen == real.people);
    REQUIRE(!reading.people.empty());
    const Track2d& track = reading.people.front();
    CHECK(track.joint_count() == real.joints);
    CHECK(track.frames() == real.frames);
    CHECK(track.keypoints.size() == track.joint_names.size());
    CHECK((track.confidence.array() >= 0).all());
    CHECK((track.confidence.array() <= 1).all());
    CHECK((track.x_px.array().isNaN() == (track.confidence.array() == 0)).all());
  }
}

TEST_CASE("real tracks: FreeMoCap's numbers in columns are refused as well") {
  const std::string path = "formats/freemocap_csv/freemocap_test_data_by_frame.csv";
  if (!have_shared_data(path, "real tracks")) return;
  const std::string text = read_text_file(shared_data() / path);
  const CsvTable table(text, path);
  std::string names;
  std::map<std::string_view, std::string> numbers;  // of a frame
  for (const CsvTable::Line& line : table.lines()) {
    if (line.cells[3] != "mediapipe_body") continue;
    if (line.cells[0] == "0") names += fmt::format(",{0}_x,{0}_y,{0}_z", line.cells[4]);
    numbers[line.cells[0]] += fmt::format(",{},{},{}", line.cells[5], line.cells[6], line.cells[7]);
  }
  REQUIRE(numbers.size() == 2);
  const ScratchFolder folder;
  const auto columns = folder.write(
      "columns.csv", fmt::format("frame{}\n0{}\n1{}\n", names, numbers["0"], numbers["1"]));
  CHECK_THROWS_WITH_AS(read_track(columns), doctest::Contains("points in space"), InputError);
}

TEST_CASE("real tracks: points in space are refused") {
  for (const auto& [path, message] :
       {std::pair{"formats/blazepose_json/pose_squats_3d.full.json", "a body in space"},
        std::pair{"formats/freemocap_csv/freemocap_test_data_by_frame.csv", "points in space"}}) {
    CAPTURE_BOUND(path);
    if (!have_shared_data(path, "real tracks")) continue;
    CHECK_THROWS_WITH_AS(read_track(shared_data() / path), doctest::Contains(message), InputError);
  }
}
