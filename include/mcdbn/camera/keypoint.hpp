#pragma once

#include <Eigen/Core>
#include <string>

#include "mcdbn/motion/joint_role.hpp"

namespace mcdbn {

/// What a column of a detector's track shows: a place on the body, said by the joint that carries
/// it.
struct Keypoint {
  std::string name;  ///< as the detector's documents spell it
  JointRole role = JointRole::pelvis;
  /// From the joint's centre to the place, as shares of body height, in the axes of a body that
  /// stands upright: x to its left, y up, z forward. It turns with the joint.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

}  // namespace mcdbn
