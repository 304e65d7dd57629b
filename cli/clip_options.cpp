#include "clip_options.hpp"

#include <spdlog/spdlog.h>

#include "setting_flags.hpp"

namespace mcdbn::cli {

void add_clip_options(CLI::App& command, ClipOptions& options) {
  command.add_option("--fps", options.fps, "Resample clips to this rate; 0 keeps the file's own")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("--keep-first-frame", options.keep_first_frame,
                   "Keep a leading calibration pose");
}

Motion load_clip_with_notices(const std::filesystem::path& path, const ClipOptions& options) {
  std::vector<std::string> notices;
  Motion motion = load_clip(path, options, &notices);
  for (const std::string& notice : notices) spdlog::info("{}", with_flags(notice));
  return motion;
}

}  // namespace mcdbn::cli
