#pragma once

#include <filesystem>
#include <string>

namespace mcdbn::test {

struct CliResult {
  int exit_code = -1;
  std::string standard_output, standard_error;
};

/// Runs a program through the shell.
CliResult run_program(const std::filesystem::path& program, const std::string& arguments,
                      const std::string& environment = "");

/// Runs the built mcdbn-cl through the shell.
/// @param environment assignments in front of the command, such as "MCDBN_DEVICE=3"
CliResult run_cli(const std::string& arguments, const std::string& environment = "");

int count_lines(const std::string& text);

/// Two joints that move for `frames` frames at 120 fps, as the text of a BVH file.
std::string small_bvh(int frames, bool with_calibration_pose = false);

}  // namespace mcdbn::test
