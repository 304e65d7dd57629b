#include "evaluation/orientation_error.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Index in both skeletons of each joint of the truth that turns and that the other has.
std::vector<std::pair<std::size_t, std::size_t>> turning_joints(const Skeleton& truth,
                                                                const Skeleton& other) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = 0; j < truth.joints.size(); ++j) {
    const Joint& joint = truth.joints[j];
    if (std::ranges::none_of(joint.channels, is_rotation)) continue;
    if (const int there = other.find(joint.name); there >= 0)
      pairs.emplace_back(j, static_cast<std::size_t>(there));
  }
  return pairs;
}

}  // namespace

double mpjae_deg(const Motion& truth, const Motion& regenerated) {
  if (truth.frames() != regenerated.frames())
    throw ShapeError(
        fmt::format("orientations of {} frames and of {}", truth.frames(), regenerated.frames()));
  const auto joints = turning_joints(truth.skeleton, regenerated.skeleton);
  if (joints.empty() || truth.frames() == 0) return kNan;
  double sum = 0;
  for (int t = 0; t < truth.frames(); ++t) {
    const WorldPose real = forward_kinematics(truth.skeleton, truth.channels.row(t)),
                    other = forward_kinematics(regenerated.skeleton, regenerated.channels.row(t));
    for (const auto& [own, there] : joints)
      sum +=
          Eigen::AngleAxisd(real.world_from_joint[own].transpose() * other.world_from_joint[there])
              .angle();
  }
  return sum / kRadiansPerDegree /
         (static_cast<double>(joints.size()) * static_cast<double>(truth.frames()));
}

}  // namespace mcdbn
