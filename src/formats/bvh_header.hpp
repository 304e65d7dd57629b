#pragma once

#include <filesystem>
#include <string>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// As bvh_header_text(), with offsets of a fixed width: skeletons that differ in lengths alone have
/// texts of one size.
std::string bvh_header_text_of_fixed_width(const Skeleton& skeleton);

/// The skeleton of a file as read_bvh() reads it; what stands below MOTION is not looked at.
/// @throws InputError `file:line: what`
Skeleton read_bvh_skeleton(const std::filesystem::path& path);

}  // namespace mcdbn
