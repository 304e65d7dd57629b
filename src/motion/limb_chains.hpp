#pragma once

#include <array>
#include <optional>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// A leg or an arm as the tree shows it; -1 where there is no such joint.
struct LimbChain {
  int girdle = -1;  ///< before the limb's first joint, not on the trunk: a clavicle
  int first = -1;   ///< the thigh's or the upper arm's
  int middle = -1;  ///< knee or elbow
  int end = -1;     ///< ankle or wrist
  int tip = -1;     ///< toes or hand
};

/// A body as its tree of bones shows it, without names.
struct BodyChains {
  int pelvis = -1, chest = -1, neck = -1, head = -1;
  /// Left and right; none where no pair of like chains is there.
  std::optional<std::array<LimbChain, 2>> legs, arms;
};

BodyChains body_chains(const Skeleton& skeleton);

}  // namespace mcdbn
