#include "motion/mean_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "motion/body_size.hpp"
#include "motion/joint_matching.hpp"

namespace mcdbn {
namespace {

/// People's bones rest within a few degrees of each other, capture systems' anywhere.
constexpr double kSameDirection_deg = 30;

bool is_bone(const Joint& joint) {
  return joint.parent >= 0 && std::ranges::all_of(joint.channels, is_rotation);
}

bool same_direction(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  const double cosine = std::cos(kSameDirection_deg * kRadiansPerDegree);
  return one.dot(other) >= cosine * one.norm() * other.norm();
}

}  // namespace

Skeleton mean_body(const std::vector<Skeleton>& people) {
  const Skeleton& first = people.front();
  Skeleton result = first;
  std::vector<std::vector<int>> joints;
  std::vector<double> of_first;  // how many times as large the first is
  for (std::size_t i = 0; i < people.size(); ++i) {
    joints.push_back(match_joints(first, people[i], fmt::format("person {}", i + 1)));
    of_first.push_back(file_units_per_metre(first) / file_units_per_metre(people[i]));
  }
  for (std::size_t j = 0; j < first.joints.size(); ++j) {
    const Joint& joint = first.joints[j];
    if (!is_bone(joint)) continue;
    Eigen::Vector3d sum(0, 0, 0);
    bool alike = true;
    for (std::size_t i = 0; i < people.size(); ++i) {
      const auto of_person = static_cast<std::size_t>(joints[i][j]);
      const Eigen::Vector3d bone = of_first[i] * people[i].joints[of_person].offset;
      alike = alike && same_direction(joint.offset, bone);
      sum += bone;
    }
    if (alike) result.joints[j].offset = sum / static_cast<double>(people.size());
  }
  return result;
}

}  // namespace mcdbn
