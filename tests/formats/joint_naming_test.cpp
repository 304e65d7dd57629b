// Which names of a file's columns are a detector's, and which a skeleton's.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;

namespace joint_naming_test {

namespace {

/// The keypoints of a file of that format whose columns have these names.
std::vector<Keypoint> keypoints_read(const std::string& format,
                                     const std::vector<std::string>& names) {
  const test::ScratchFolder folder;
  Track2d track;
  track.joint_names = names;
  const auto joints = static_cast<Eigen::Index>(names.size());
  track.x_px = track.y_px = MatrixD::Constant(3, joints, 200);
  track.confidence = MatrixD::Ones(3, joints);
  track_format(format).write(folder / "track", track);
  const Track2d read = read_track(folder / "track", {.format = format});
  CHECK(read.joint_names == names);
  return read.keypoints;
}

}  // namespace

TEST_CASE("joint names: a skeleton's have no places of a detector, whatever format holds them") {
  const std::vector<std::string> cmu{
      "Hips",         "LHipJoint",     "LeftUpLeg",    "LeftLeg",      "LeftFoot",
      "LeftToeBase",  "RHipJoint",     "RightUpLeg",   "RightLeg",     "RightFoot",
      "RightToeBase", "LowerBack",     "Spine",        "Spine1",       "Neck",
      "Neck1",        "Head",          "LeftShoulder", "LeftArm",      "LeftForeArm",
      "LeftHand",     "RightShoulder", "RightArm",     "RightForeArm", "RightHand"};
  const std::vector<std::string> bandai{
      "Hips",       "Spine",  "Chest",      "Neck",       "Head",       "Shoulder_L", "UpperArm_L",
      "LowerArm_L", "Hand_L", "Shoulder_R", "UpperArm_R", "LowerArm_R", "Hand_R",     "UpperLeg_L",
      "LowerLeg_L", "Foot_L", "Toes_L",     "UpperLeg_R", "LowerLeg_R", "Foot_R",     "Toes_R"};
  for (const char* format : {"csv", "sleap", "deeplabcut"}) {
    CAPTURE(format);
    CHECK(keypoints_read(format, cmu).empty());
    CHECK(keypoints_read(format, bandai).empty());
  }
}

TEST_CASE("joint names: a detector's in other spellings keep their places, an animal's have none") {
  const std::vector<std::string> spelled{
      "Nose",  "shoulder.L", "shoulder.R", "elbow.L", "elbow.R", "wrist.L", "wrist.R", "hip.L",
      "hip.R", "knee.L",     "knee.R",     "ankle.L", "ankle.R", "heel.L",  "heel.R"};
  const std::vector<std::string> mouse{"snout", "left_ear", "right_ear", "tail", "left_hip"};
  for (const char* format : {"sleap", "deeplabcut"}) {
    CAPTURE(format);
    const std::vector<Keypoint> places = keypoints_read(format, spelled);
    REQUIRE(places.size() == spelled.size());
    CHECK(places[0].role == JointRole::head);
    CHECK(places[13].role == JointRole::left_ankle);
    const std::vector<Keypoint> none = keypoints_read(format, mouse);
    REQUIRE(none.size() == mouse.size());
    for (const Keypoint& keypoint : none) CHECK(!keypoint.role);
  }
}

TEST_CASE("joint names: a whole body in OpenPose's order begins with COCO's 18") {
  const test::ScratchFolder folder;
  nlohmann::json points = nlohmann::json::array();
  for (int joint = 0; joint < 134; ++joint) points.push_back({100 + joint, 200});
  const std::vector<double> scores(134, 0.5);
  const nlohmann::json person{{"keypoints", points}, {"keypoint_scores", scores}};
  const TrackReading reading =
      read_tracks(folder.write("rtmlib.json", nlohmann::json::array({person}).dump()));
  CHECK(reading.joint_set == "COCO_18");
  const Track2d& track = reading.people.front();
  REQUIRE(track.joint_count() == 18);
  REQUIRE(track.keypoints.size() == 18);
  CHECK(track.keypoints[1].role == joint_set("COCO_18").keypoints[1].role);
  CHECK(track.x_px(0, 17) == 117);
}

}  // namespace joint_naming_test
