#pragma once

#include <filesystem>

#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// Roles given by hand, for skeletons whose names and shape do not suffice: TOML with a line
/// `role = "joint name"` for each, roles as name_of(JointRole) spells them.
/// @throws InputError `file:line: what`
JointMap read_joint_map(const std::filesystem::path& path);

}  // namespace mcdbn
