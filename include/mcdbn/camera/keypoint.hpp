#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>

#include "mcdbn/motion/joint_role.hpp"

namespace mcdbn {

/// The place on the body that a column of a detector's track shows, relative to the joint that
/// carries it.
struct Keypoint {
  std::string name;  ///< as the detector's documents spell it
  /// The joint that carries the place; none where no joint does, or nothing is known of the place
  /// (an animal's tail).
  std::optional<JointRole> role;
  /// From the joint's centre to the place, as shares of body height, in the axes of a body that
  /// stands upright: x to its left, y up, z forward. It turns with the joint.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  /// Where the detector defines the place as halfway between two joints, as OpenPose does its
  /// MidHip: those two. `role`, if there is one, and `offset` then give its approximate place.
  std::optional<std::pair<JointRole, JointRole>> halfway;
};

}  // namespace mcdbn
