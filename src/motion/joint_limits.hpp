#pragma once

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// How far a joint turns against its parent: a box of rotation vectors about its middle, along the
/// principal axes of how it was seen to turn, so that a knee's is long and thin.
class JointLimits {
 public:
  /// From rotations that were seen: all but half a percent at either end of each axis, and 5
  /// degrees beyond. @param seen parent_from_joint, at least one
  static JointLimits of(const std::vector<Eigen::Matrix3d>& seen);

  /// The rotation if it is within, or not farther out than `as_seen` along each axis; else the
  /// nearest that is.
  Eigen::Matrix3d clamped(const Eigen::Matrix3d& rotation, const Eigen::Matrix3d& as_seen) const;

 private:
  Eigen::Vector3d coordinates(const Eigen::Matrix3d& rotation) const;

  Eigen::Matrix3d middle_ = Eigen::Matrix3d::Identity(), axes_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d low_{0, 0, 0}, high_{0, 0, 0};
};

}  // namespace mcdbn
