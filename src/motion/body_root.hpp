#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Whether the joint has a position channel, that is, moves against its parent.
bool has_position(const Joint& joint);

/// The only child of `joint`, or -1.
int only_child(const Skeleton& skeleton, int joint);

/// Where the body begins: the last joint with position channels on joint 0's chain of only
/// children, else joint 0. The offset of this joint and of those before it is where the clip
/// happens to stand, not a bone; all joints after it are below it.
int body_root(const Skeleton& skeleton);

}  // namespace mcdbn
