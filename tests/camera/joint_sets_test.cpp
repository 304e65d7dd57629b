#include "mcdbn/camera/joint_sets.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

std::string mirrored(std::string name) {
  const auto swap = [&](const std::string& from, const std::string& to) {
    const auto at = name.find(from);
    if (at == std::string::npos) return false;
    name.replace(at, from.size(), to);
    return true;
  };
  if (swap("left", "right") || swap("right", "left")) return name;
  // OpenPose: LShoulder.
  if (name.size() > 1 && std::isupper(name[1]) != 0 && (name[0] == 'L' || name[0] == 'R'))
    name[0] = name[0] == 'L' ? 'R' : 'L';
  return name;
}

}  // namespace

TEST_CASE("joint sets: every name is there once, and its other side too") {
  for (const JointSet& set : joint_sets()) {
    CAPTURE(set.name);
    std::set<std::string> names;
    for (const Keypoint& keypoint : set.keypoints) CHECK(names.insert(keypoint.name).second);
    for (const Keypoint& keypoint : set.keypoints) {
      CAPTURE(keypoint.name);
      const auto other = std::ranges::find(set.keypoints, mirrored(keypoint.name), &Keypoint::name);
      REQUIRE(other != set.keypoints.end());
      CHECK(other->role.has_value() == keypoint.role.has_value());
      if (keypoint.role) CHECK(*other->role == other_side(*keypoint.role));
      CHECK(other->offset.x() == -keypoint.offset.x());
      CHECK(other->offset.tail<2>() == keypoint.offset.tail<2>());
      CHECK(keypoint.offset.norm() < 0.1);
      if (keypoint.name.find("humb") == std::string::npos && keypoint.name != "spine")
        CHECK(keypoint.role.has_value());
    }
    CHECK(&joint_set(set.name) == &set);
  }
  CHECK_THROWS_WITH_AS(joint_set("BODY_26"), doctest::Contains("BODY_25B"), InputError);
}

TEST_CASE("joint sets: the orders of the detectors' documents") {
  const auto at = [](const char* set, int index) { return joint_set(set).keypoints[index]; };
  CHECK(at("BODY_25", 8).name == "MidHip");
  CHECK(at("BODY_25", 8).halfway == std::pair{JointRole::left_hip, JointRole::right_hip});
  CHECK(at("BODY_25", 4).role == JointRole::right_wrist);
  CHECK(at("BODY_25", 24).name == "RHeel");
  CHECK(at("BODY_25B", 4).name == "REar");
  CHECK(at("BODY_25B", 17).role == JointRole::head);  // MPII's upper neck
  CHECK(at("COCO_18", 17).name == "LEar");
  CHECK(at("COCO_17", 16).role == JointRole::right_ankle);
  CHECK(at("HALPE_26", 20).name == "left_big_toe");
  CHECK(at("HALPE_26", 21).name == "right_big_toe");
  CHECK(at("COCO_23", 19).name == "left_heel");
  CHECK(at("MEDIAPIPE_33", 32).name == "right_foot_index");
  CHECK(at("H36M_17", 16).role == JointRole::right_wrist);
  CHECK(at("H36M_17", 3).role == JointRole::right_ankle);
  // Halfway between hips and thorax: not the lowest joint of a skeleton's spine.
  CHECK(at("H36M_17", 7).name == "spine");
  CHECK(!at("H36M_17", 7).role);
  CHECK(at("H36M_17", 7).halfway == std::pair{JointRole::pelvis, JointRole::neck});
}

TEST_CASE("keypoints: names in the usual spellings") {
  for (const char* name :
       {"LShoulder", "left_shoulder", "shoulder_left", "Left Shoulder", "shoulder.L", "lshoulder",
        "LEFT_SHOULDER", "leftShoulder", "PoseLandmark.LEFT_SHOULDER"}) {
    CAPTURE(name);
    CHECK(keypoint_of(name).role == JointRole::left_shoulder);
    CHECK(keypoint_of(name).name == name);
  }
  CHECK(keypoint_of("RBigToe").role == JointRole::right_toe);
  CHECK(keypoint_of("RBigToe").offset.x() == -keypoint_of("LBigToe").offset.x());
  CHECK(keypoint_of("nose").role == JointRole::head);
  for (const char* name : {"tail", "shoulder", "left", "", "left_right_hip", "left_nose", "lash"})
    CHECK(!keypoint_of(name).role);
}

TEST_CASE("keypoints: the left ear of a mouse is no left ear") {
  const std::vector<std::string> mouse{"snout", "left_ear", "right_ear", "tail", "left_hip"};
  for (const Keypoint& keypoint : keypoints_of(mouse)) CHECK(!keypoint.role);
  const std::vector<std::string> human{"left_ear",  "left_hip",   "right_hip",
                                       "left_knee", "right_knee", "ball"};
  const auto keypoints = keypoints_of(human);
  CHECK(keypoints[0].role == JointRole::head);
  CHECK(keypoints[4].role == JointRole::right_knee);
  CHECK(!keypoints[5].role);
}

TEST_CASE("keypoints: a foot is the ankle where nothing else is at the ankle, else the toes") {
  using enum JointRole;
  using Names = std::vector<std::string>;
  // @return the roles of LFoot and RFoot beside those names and the usual ones
  const auto feet = [](Names names) {
    for (const char* name : {"RHip", "RKnee", "LHip", "LKnee", "LFoot", "RFoot"})
      names.emplace_back(name);
    const auto keypoints = keypoints_of(names);
    const Keypoint &left = keypoints[names.size() - 2], &right = keypoints.back();
    for (const Keypoint* foot : {&left, &right}) {
      REQUIRE(foot->role);
      CHECK(foot->offset.isZero());
    }
    return std::pair{*left.role, *right.role};
  };
  // VideoPose3D's spelling of Human3.6M's joints.
  CHECK(feet({"Hip", "Spine", "Thorax", "Nose", "Head", "LShoulder", "LElbow", "LWrist",
              "RShoulder", "RElbow", "RWrist"}) == std::pair{left_ankle, right_ankle});
  CHECK(feet({"left_toes", "RBigToe"}) == std::pair{left_ankle, right_ankle});
  CHECK(feet({"LAnkle", "RAnkle"}) == std::pair{left_toe, right_toe});
  CHECK(feet({"LHeel", "RHeel"}) == std::pair{left_toe, right_toe});
  CHECK(feet({"RAnkle"}) == std::pair{left_ankle, right_toe});
  // Paws and hips alone make no human.
  for (const Keypoint& keypoint : keypoints_of(Names{"LHip", "RHip", "LFoot", "RFoot", "tail"}))
    CHECK(!keypoint.role);
}
