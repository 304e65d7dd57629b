#pragma once

#include <string>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// As bvh_header_text(), with offsets of a fixed width: skeletons that differ in lengths alone have
/// texts of one size.
std::string bvh_header_text_of_fixed_width(const Skeleton& skeleton);

}  // namespace mcdbn
