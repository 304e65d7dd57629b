#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace mcdbn {

/// A bone of an ASF file; the root is one without length.
struct AsfBone {
  std::string name;
  int parent = -1;
  Eigen::Vector3d end_cm{0, 0, 0};  ///< from its nearer end to the other one, at rest
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// What its numbers in the AMC mean, in their order: 0, 1, 2 turn about x, y, z; the root's 3, 4,
  /// 5 move along them.
  std::vector<int> freedoms;
};

struct AsfSkeleton {
  std::vector<AsfBone> bones;  ///< the root first, parents before their children
  Eigen::Vector3d root_cm{0, 0, 0};
  double cm_per_unit = 1;
};

/// Rotations about x, y, z, the first of `order` done first. @param angles_deg in that order
Eigen::Matrix3d turn_of(const std::vector<int>& order, const std::vector<double>& angles_deg);

/// The text with its comments (from # to the line's end) blanked, lines kept.
std::string without_comments(std::string_view text);

/// @throws InputError `name:line: what`
AsfSkeleton parse_asf(std::string_view text, const std::string& name);

}  // namespace mcdbn
