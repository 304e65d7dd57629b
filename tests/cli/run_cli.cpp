#include "run_cli.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"

namespace mcdbn::test {

CliResult run_program(const std::filesystem::path& program, const std::string& arguments,
                      const std::string& environment) {
  const ScratchFolder folder;
  const std::filesystem::path errors = folder / "stderr";
  const std::string command =
      fmt::format("{} '{}' {} 2>'{}'", environment, program.string(), arguments, errors.string());
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot start " + command);
  CliResult result;
  std::array<char, 4096> block{};
  while (const std::size_t length = fread(block.data(), 1, block.size(), pipe)) {
    result.standard_output.append(block.data(), length);
  }
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.standard_error = read_text_file(errors);
  return result;
}

CliResult run_cli(const std::string& arguments, const std::string& environment) {
  return run_program(MCDBN_CLI, arguments, environment);
}

int count_lines(const std::string& text) {
  return static_cast<int>(std::ranges::count(text, '\n'));
}

std::string small_bvh(int frames, bool with_calibration_pose) {
  std::string text = fmt::format(
      "HIERARCHY\nROOT Hips\n{{\n  OFFSET 0 0 0\n"
      "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
      "  JOINT Chest\n  {{\n    OFFSET 0 50 0\n"
      "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
      "    End Site\n    {{\n      OFFSET 0 50 0\n    }}\n  }}\n}}\n"
      "MOTION\nFrames: {}\nFrame Time: 0.0083333\n",
      frames + (with_calibration_pose ? 1 : 0));
  if (with_calibration_pose) text += "0 0 0 0 0 0 0 0 0\n";
  for (int frame = 0; frame < frames; ++frame) {
    text += fmt::format("0 90 {} 25 40 {} {} -35 20\n", frame, 10 + 0.1 * frame, 30 + 0.2 * frame);
  }
  return text;
}

}  // namespace mcdbn::test
