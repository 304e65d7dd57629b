#include "motion/joint_limits.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "base/numbers.hpp"
#include "motion/nearest_rotation.hpp"
#include "motion/rotation_vector.hpp"

namespace mcdbn {

JointLimits JointLimits::of(const std::vector<Eigen::Matrix3d>& seen) {
  constexpr double kLeftOut = 0.005, kBeyond = 5 * kRadiansPerDegree;
  JointLimits limits;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& rotation : seen) sum += rotation;
  limits.middle_ = nearest_rotation(sum);
  for (const Eigen::Matrix3d& rotation : seen) {
    const Eigen::Vector3d turn = limits.coordinates(rotation);
    spread += turn * turn.transpose();
  }
  limits.axes_ = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> turns;
    turns.reserve(seen.size());
    for (const Eigen::Matrix3d& rotation : seen)
      turns.push_back(limits.coordinates(rotation)[axis]);
    std::ranges::sort(turns);
    const auto out = static_cast<std::size_t>(kLeftOut * static_cast<double>(turns.size()));
    limits.low_[axis] = turns[out] - kBeyond;
    limits.high_[axis] = turns[turns.size() - 1 - out] + kBeyond;
  }
  return limits;
}

Eigen::Vector3d JointLimits::coordinates(const Eigen::Matrix3d& rotation) const {
  return axes_.transpose() * rotation_vector(middle_.transpose() * rotation);
}

Eigen::Matrix3d JointLimits::clamped(const Eigen::Matrix3d& rotation,
                                     const Eigen::Matrix3d& as_seen) const {
  const Eigen::Vector3d seen = coordinates(as_seen), low = low_.cwiseMin(seen),
                        high = high_.cwiseMax(seen), turn = coordinates(rotation),
                        within = turn.cwiseMax(low).cwiseMin(high);
  if (within == turn) return rotation;
  return middle_ * rotation_of(axes_ * within);
}

}  // namespace mcdbn
