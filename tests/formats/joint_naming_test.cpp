// Which names of a file's columns are a detector's, and which a skeleton's.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
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

}  // namespace joint_naming_test
