#include "camera/keypoint_map.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/keypoint_places.hpp"
#include "camera/keypoint_track.hpp"
#include "camera/role_body.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/rest_pose.hpp"

namespace keypoint_map_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Somebody with feet who turns once round on the spot while every joint swings.
struct Scene {
  Motion motion;
  SkeletonRoles roles;
  Camera camera;
  Track2d joints;  ///< exact

  Scene() {
    Skeleton body = role_body();
    body.joints[0].offset.setZero();
    for (const char* side : {"Left", "Right"})
      body.joints.push_back(make_joint(std::string(side) + "Toe",
                                       body.find(std::string(side) + "Foot"), {0, -6, 14},
                                       {z_rotation, x_rotation, y_rotation}));
    motion = standing_still(body, 60);
    motion.frame_time_s = 1.0 / 30;
    for (int t = 0; t < motion.frames(); ++t)
      for (int c = 3; c < body.channel_count(); ++c)
        motion.channels(t, c) = c == 5 ? 6.0 * t : 15 * std::sin(0.2 * t + c);
    roles = skeleton_roles(body);
    CameraPlacement placement;
    placement.elevation_deg = 0;
    camera = place_camera(motion, placement);
    joints = project_motion(motion, camera);
  }
  KeypointMap map(const std::vector<Keypoint>& keypoints) const {
    return {keypoints, motion.skeleton, roles};
  }
  /// Mean distance of a joint from where it is, in pixels.
  double off_px(const Track2d& track, const std::string& joint) const {
    const int here = track.find(joint), there = joints.find(joint);
    REQUIRE(here >= 0);
    return ((track.x_px.col(here) - joints.x_px.col(there)).array().square() +
            (track.y_px.col(here) - joints.y_px.col(there)).array().square())
        .sqrt()
        .mean();
  }
};

void lose(Track2d& track, const std::string& place, int frame) {
  track.confidence(frame, track.find(place)) = 0;
}

}  // namespace

TEST_CASE("keypoint map: with the true answer every joint is where it is") {
  const Scene scene;
  for (const auto& keypoints : {body_25_keypoints(), coco_keypoints()}) {
    const Track2d seen = keypoint_track(scene.motion, scene.camera, keypoints);
    const Track2d track = scene.map(keypoints).joints_of(seen, scene.motion, scene.camera);
    CHECK(track.keypoints.empty());
    CHECK(track.fps == doctest::Approx(30));
    CHECK(track.confidence.minCoeff() == 1);
    const bool feet = keypoints.size() > 17;
    CHECK(track.joint_count() == (feet ? 17 : 15));
    for (const std::string& joint : track.joint_names) {
      CAPTURE(joint);
      CHECK(scene.off_px(track, joint) < 1e-6);
    }
  }
}

TEST_CASE("keypoint map: before an answer, left and up follow from hips and shoulders") {
  const Scene scene;
  const double height_px = 0.9 * scene.camera.height_px;
  for (const auto& keypoints : {body_25_keypoints(), coco_keypoints()}) {
    const Track2d seen = keypoint_track(scene.motion, scene.camera, keypoints);
    const Track2d track = scene.map(keypoints).joints_of(seen);
    // The pelvis is 5 units above the hips, the neck 4 above the shoulders: 3 % of height.
    CHECK(scene.off_px(track, "Hips") < 0.006 * height_px);
    CHECK(scene.off_px(track, "Neck") < 0.008 * height_px);
    CHECK(scene.off_px(track, "Head") < 0.02 * height_px);  // ears; the nose alone is 0.05 off
    CHECK(scene.off_px(track, "LeftLeg") < 1e-6);
  }
}

TEST_CASE("keypoint map: what is not seen is missing, and others stand in") {
  const Scene scene;
  const auto keypoints = coco_keypoints();
  Track2d seen = keypoint_track(scene.motion, scene.camera, keypoints);
  seen.confidence.col(seen.find("left_knee")).setConstant(0.25);
  lose(seen, "left_knee", 3);
  lose(seen, "left_hip", 4);
  lose(seen, "left_ear", 5);
  for (const char* place : {"nose", "left_eye", "right_eye", "left_ear", "right_ear"})
    lose(seen, place, 6);
  seen.x_px(7, seen.find("right_knee")) = std::numeric_limits<double>::quiet_NaN();
  const KeypointMap map = scene.map(keypoints);
  for (const Track2d& track :
       {map.joints_of(seen), map.joints_of(seen, scene.motion, scene.camera)}) {
    const auto missing = [&](int frame, const char* joint) {
      const int column = track.find(joint);
      CHECK(std::isnan(track.x_px(frame, column)) == (track.confidence(frame, column) == 0));
      return std::isnan(track.x_px(frame, column));
    };
    CHECK(missing(3, "LeftLeg"));
    CHECK_FALSE(missing(2, "LeftLeg"));
    CHECK(track.confidence(2, track.find("LeftLeg")) == doctest::Approx(0.25));
    CHECK(missing(4, "LeftUpLeg"));
    CHECK(missing(4, "Hips"));
    CHECK_FALSE(missing(5, "Head"));
    CHECK(missing(6, "Head"));
    CHECK(missing(7, "RightLeg"));
    CHECK_FALSE(missing(7, "LeftLeg"));
    CHECK(track.find("LeftToe") < 0);
  }
}

TEST_CASE("keypoint map: what follows from other joints alone is no evidence") {
  const Scene scene;
  for (auto keypoints : {coco_keypoints(), body_25_keypoints()}) {
    const auto hidden = [&](const char* name) {
      const Track2d seen = keypoint_track(scene.motion, scene.camera, keypoints);
      const KeypointMap map = scene.map(keypoints);
      const Track2d joints = map.joints_of(seen), evidence = map.evidence(joints);
      CHECK(evidence.x_px.col(evidence.find("LeftLeg")) == joints.x_px.col(joints.find("LeftLeg")));
      CHECK(evidence.confidence.col(evidence.find("LeftLeg")).minCoeff() == 1);
      // Its ears are 0.042 of body height off, and turned by 0.3 rad more or less.
      CHECK(evidence.confidence(0, evidence.find("Head")) == doctest::Approx(0.39).epsilon(0.02));
      return (evidence.confidence.col(evidence.find(name)).array() == 0).all();
    };
    CHECK(hidden("Hips"));
    CHECK(hidden("Neck"));
    keypoints.push_back(keypoint("sacrum", JointRole::pelvis, {0, 0, -0.05}));
    CHECK_FALSE(hidden("Hips"));
  }
}

TEST_CASE("keypoint map: a place that no joint carries shows none") {
  // Human3.6M's spine is halfway up the trunk; the humanoid's `spine` is its lowest joint.
  const Motion motion = standing_still(canonical_humanoid(), 2);
  const auto& keypoints = joint_set("H36M_17").keypoints;
  const Track2d seen = keypoint_track(motion, place_camera(motion, {}), keypoints);
  const KeypointMap map(keypoints, motion.skeleton, humanoid_roles());
  const Track2d joints = map.joints_of(seen);
  CHECK(joints.find("neck") >= 0);
  CHECK(joints.find("spine") < 0);
}

TEST_CASE("keypoint map: too little of a body is refused") {
  const Scene scene;
  auto upper = coco_keypoints();
  std::erase_if(upper, [](const Keypoint& place) { return place.name.ends_with("_hip"); });
  CHECK_THROWS_WITH_AS(scene.map(upper), doctest::Contains("the pelvis or both hips"), InputError);
  std::vector<Keypoint> two;
  add_sides(two, "ear", JointRole::head);
  two.push_back(keypoint("mid_hip", JointRole::pelvis));
  CHECK_THROWS_WITH_AS(scene.map(two), doctest::Contains("2 of the model's joints (Head, Hips)"),
                       InputError);
  Keypoint nothing;
  nothing.name = "tail";
  CHECK_THROWS_WITH_AS(scene.map({nothing}),
                       doctest::Contains("0 of the model's joints; at least 3 are needed, the "
                                         "pelvis or both hips among them; its columns 'tail' are "
                                         "no known joints: call them as"),
                       InputError);
  CHECK_THROWS_WITH_AS(scene.map(std::vector<Keypoint>(7, nothing)),
                       doctest::Contains("'tail', 'tail', 'tail', 'tail', 'tail', … are"),
                       InputError);
  CHECK_THROWS_AS(scene.map({}), InputError);
  const KeypointMap map = scene.map(coco_keypoints());
  Motion shorter = scene.motion;
  shorter.channels = MatrixD(shorter.channels.topRows(3));
  CHECK_THROWS_AS(map.joints_of(keypoint_track(scene.motion, scene.camera, coco_keypoints()),
                                shorter, scene.camera),
                  ShapeError);
}

TEST_CASE("no joint turned: unturned_pose puts the root at its offset, rest_pose at the origin") {
  Skeleton body = role_body();
  const Eigen::Vector3d offset(3, 90, -2);
  body.joints[0].offset = offset;
  const WorldPose unturned = unturned_pose(body), rest = rest_pose(body);
  CHECK((unturned.position[0] - offset).norm() < 1e-12);
  CHECK(rest.position[0].isZero());
  for (std::size_t joint = 0; joint < rest.position.size(); ++joint)
    CHECK((unturned.position[joint] - offset - rest.position[joint]).norm() < 1e-9);
}

}  // namespace keypoint_map_test
