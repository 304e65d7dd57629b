#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// Which lines of a joint map name a joint of some clip. A map may be of several skeletons, so that
/// a clip need not have all of its joints; a name that no clip has is a mistake.
class JointMapUse {
 public:
  explicit JointMapUse(JointMap joint_map) : unused_(std::move(joint_map)) {}

  /// A clip's own skeleton, before it is brought onto another.
  void add(const Skeleton& skeleton);
  /// A line for each name that no clip had.
  std::vector<std::string> notices() const;

 private:
  JointMap unused_;
};

}  // namespace mcdbn
