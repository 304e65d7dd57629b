#pragma once

#include <string_view>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// For every joint of `wanted` the index of the joint of that name in `skeleton`.
/// @param what names `skeleton` in the message  @throws InputError if a joint is missing
std::vector<int> match_joints(const Skeleton& wanted, const Skeleton& skeleton,
                              std::string_view what);

/// Position of `channel` among the joint's channels, or -1.
int find_channel(const Joint& joint, Channel channel);

}  // namespace mcdbn
