#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Whether the name ends as a file of motion does: .bvh or .amc, in any case. macOS' `._NAME` is
/// none.
bool is_motion_file(const std::filesystem::path& path);

/// The ASF beside an AMC that holds its skeleton; empty of any other file, which has its own.
/// @throws InputError if an AMC has none
std::filesystem::path skeleton_file_of(const std::filesystem::path& path);

/// Reads BVH, or Acclaim's AMC by the ending .amc. An AMC's skeleton is the ASF beside it: 16.asf
/// (or 16_15.asf) of 16_15.amc, else the only one in the folder. Its lengths become centimetres,
/// its rate is taken to be CMU's 120 Hz, for the file gives none.
/// @param warnings if given, collects a line for each thing that was odd or taken for granted
/// @throws InputError `file:line: what`
Motion read_motion(const std::filesystem::path& path, std::vector<std::string>* warnings = nullptr);

/// The skeleton that read_motion() reads; the frames are not looked at.
/// @throws InputError `file:line: what`
Skeleton read_skeleton(const std::filesystem::path& path);

/// As read_motion(), of a file that was read before. @param text all that it holds
Motion parse_motion(std::string_view text, const std::filesystem::path& path,
                    std::vector<std::string>* warnings = nullptr);

}  // namespace mcdbn
