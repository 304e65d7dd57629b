#pragma once

#include <string>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "motion/body_size.hpp"

namespace mcdbn::test {

inline Keypoint keypoint(std::string name, JointRole role,
                         const Eigen::Vector3d& offset = {0, 0, 0}) {
  Keypoint result;
  result.name = std::move(name);
  result.role = role;
  result.offset = offset;
  return result;
}

/// Both sides of a place, left first.
inline void add_sides(std::vector<Keypoint>& keypoints, const std::string& name, JointRole left,
                      const Eigen::Vector3d& offset = {0, 0, 0}) {
  keypoints.push_back(keypoint("left_" + name, left, offset));
  keypoints.push_back(
      keypoint("right_" + name, other_side(left), offset.cwiseProduct(Eigen::Vector3d(-1, 1, 1))));
}

/// COCO's 17 places.
inline std::vector<Keypoint> coco_keypoints() {
  using enum JointRole;
  std::vector<Keypoint> keypoints{keypoint("nose", head, {0, 0, 0.075})};
  add_sides(keypoints, "eye", head, {0.018, 0.026, 0.052});
  add_sides(keypoints, "ear", head, {0.039, 0.014, 0.006});
  add_sides(keypoints, "shoulder", left_shoulder);
  add_sides(keypoints, "elbow", left_elbow);
  add_sides(keypoints, "wrist", left_wrist);
  add_sides(keypoints, "hip", left_hip);
  add_sides(keypoints, "knee", left_knee);
  add_sides(keypoints, "ankle", left_ankle);
  return keypoints;
}

/// OpenPose's 25 places, as far as they differ: COCO's, two halfway, and the feet.
inline std::vector<Keypoint> body_25_keypoints() {
  using enum JointRole;
  std::vector<Keypoint> keypoints = coco_keypoints();
  keypoints.push_back(keypoint("neck", neck));
  keypoints.back().halfway = {left_shoulder, right_shoulder};
  keypoints.push_back(keypoint("mid_hip", pelvis));
  keypoints.back().halfway = {left_hip, right_hip};
  add_sides(keypoints, "big_toe", left_toe, {-0.012, -0.005, 0.035});
  add_sides(keypoints, "small_toe", left_toe, {0.020, -0.005, 0.015});
  add_sides(keypoints, "heel", left_ankle, {0, -0.028, -0.038});
  return keypoints;
}

/// What a camera sees of the keypoints of a body whose joints' axes are the body's in its rest pose
/// (x left, y up, z forward).
inline Track2d keypoint_track(const Motion& motion, const Camera& camera,
                              const std::vector<Keypoint>& keypoints) {
  const SkeletonRoles roles = skeleton_roles(motion.skeleton);
  const double height = body_height(motion.skeleton);
  const auto count = static_cast<Eigen::Index>(keypoints.size());
  MatrixD points(motion.frames(), 3 * count);
  for (int t = 0; t < motion.frames(); ++t) {
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(t));
    for (Eigen::Index k = 0; k < count; ++k) {
      const Keypoint& shown = keypoints[static_cast<std::size_t>(k)];
      Eigen::Vector3d place;
      if (shown.halfway) {
        place = 0.5 * (pose.position[roles.joint(shown.halfway->first)] +
                       pose.position[roles.joint(shown.halfway->second)]);
      } else {
        const int joint = roles.joint(*shown.role);
        place = pose.position[joint] + height * (pose.world_from_joint[joint] * shown.offset);
      }
      points.row(t).segment<3>(3 * k) = place.transpose();
    }
  }
  const MatrixD pixels = project_points(camera, points);
  Track2d track;
  track.fps = motion.fps();
  track.width_px = camera.width_px;
  track.height_px = camera.height_px;
  track.keypoints = keypoints;
  for (const Keypoint& shown : keypoints) track.joint_names.push_back(shown.name);
  track.x_px.resize(motion.frames(), count);
  track.y_px.resize(motion.frames(), count);
  track.confidence = MatrixD::Ones(motion.frames(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    track.x_px.col(k) = pixels.col(2 * k);
    track.y_px.col(k) = pixels.col(2 * k + 1);
  }
  return track;
}

}  // namespace mcdbn::test
