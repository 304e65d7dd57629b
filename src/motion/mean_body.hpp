#pragma once

#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// A body in the middle of several people's, as large as the first: each bone is the mean of
/// theirs, taken on bodies of one size. A bone that some of them rest in quite another direction,
/// and a joint that moves about in its parent's frame, stay as the first has them.
/// @param people one skeleton each, at least one; joints are matched by name
/// @throws InputError if one lacks a joint that the first has
Skeleton mean_body(const std::vector<Skeleton>& people);

}  // namespace mcdbn
