#pragma once

#include <optional>
#include <string>
#include <vector>

#include "motion/joint_sides.hpp"

namespace mcdbn {

/// The word for a joint in its name, without the side. Some words mean one thing in one file and
/// another in the next: a `leg` is a shank beside an `upleg`, and a thigh beside a `shin`.
enum class JointWord {
  hips,
  neck,
  head,
  clavicle,
  shoulder,
  upper_arm,
  arm,
  forearm,
  wrist,
  hand,
  fingers,
  hip,
  thigh,
  leg,
  shin,
  ankle,
  foot,
  toe,
};

struct NamedJoint {
  JointWord word = JointWord::hips;
  Side side = Side::middle;
};

/// Words and sides of the names, one entry a joint; none without a known word. What stands before a
/// colon, what all names begin with (`Bip01_`), what programs put before them (`J_Bip_`), marks of
/// the middle (`C_`, `_M`, `.x`) and digits at the end do not count.
std::vector<std::optional<NamedJoint>> named_joints(const std::vector<std::string>& names);

}  // namespace mcdbn
