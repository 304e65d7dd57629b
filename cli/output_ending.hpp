#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mcdbn::cli {

/// In lower case, with its dot; empty where the name has none, and of what is no file: a device and
/// a pipe may be called anything.
std::string ending_of(const std::filesystem::path& output);

/// Refuses a name that ends as another format's than those that can be written there; without an
/// ending any name will do. @param endings with their dots, in lower case
/// @throws ConfigError naming them
void check_ending(const std::filesystem::path& output, const std::vector<std::string>& endings);

/// Refuses a --write-camera whose ending is that of no format that cameras are written in.
/// @param output empty if the option was not given  @throws ConfigError naming the endings
void check_camera_output(const std::filesystem::path& output);

}  // namespace mcdbn::cli
