// The joints of a growing track: at which rate they are, and how sure.

#include "motion_model/live_joints.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>

#include "camera/keypoint_track.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "motion_model/live_scene.hpp"

namespace live_joints_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

KeypointMap coco_map(const Skeleton& skeleton) {
  return {coco_keypoints(), skeleton, skeleton_roles(skeleton)};
}

LiveJoints joints_of(const Track2d& track, std::optional<KeypointMap> map) {
  LiveJoints joints(track, 30, std::move(map));
  for (int t = 0; t < track.frames(); ++t) joints.push(frame_of(track, t));
  joints.correct_sides(track.frames());
  joints.find(0, nullptr, {});
  return joints;
}

}  // namespace

TEST_CASE("live joints: they are at the model's rate, whatever the track's own is") {
  const LiveScene scene(60, 30);
  REQUIRE(scene.track.fps == 60);
  const Track2d keypoints = keypoint_track(scene.clip, scene.camera, coco_keypoints());
  for (const LiveJoints& joints :
       {joints_of(scene.track, {}), joints_of(keypoints, coco_map(scene.clip.skeleton))}) {
    CAPTURE(joints.from_keypoints());
    CHECK(joints.joints().frames() == 30);
    CHECK(joints.joints().fps == 30);
    CHECK(joints.evidence(4).fps == 30);
  }
}

TEST_CASE("live joints: a keypoint's confidence counts by the track's usual one") {
  const LiveScene scene(30, 20);
  Track2d track = keypoint_track(scene.clip, scene.camera, coco_keypoints());
  track.confidence.setConstant(0.6);
  track.confidence(12, track.find("left_wrist")) = 0.3;
  const LiveJoints joints = joints_of(track, coco_map(scene.clip.skeleton));
  const auto confidence = [&](Eigen::Index frame) {
    return joints.evidence(0).confidence(frame, joints.joints().find("LeftHand"));
  };
  CHECK(confidence(11) == doctest::Approx(1));
  CHECK(confidence(12) == doctest::Approx(std::pow(0.5, 2.5)));
}

}  // namespace live_joints_test
