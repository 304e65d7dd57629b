#include "clip_options.hpp"

#include <spdlog/spdlog.h>

#include "mcdbn/motion/frame_rate.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

void add_clip_options(CLI::App& command, ClipOptions& options) {
  command.add_option("--fps", options.fps, "Resample clips to this rate; 0 keeps the file's own")
      ->check(in_range(within(0, kFrameRate_hz.most)))
      ->capture_default_str();
  add_keep_first_frame_option(command, options.keep_first_frame);
}

void add_keep_first_frame_option(CLI::App& command, bool& keep_first_frame) {
  command.add_flag("--keep-first-frame", keep_first_frame, "Keep a leading calibration pose");
}

Motion load_clip_with_notices(const std::filesystem::path& path, const ClipOptions& options) {
  std::vector<std::string> notices;
  Motion motion = load_clip(path, options, &notices);
  for (const std::string& notice : notices) spdlog::warn("{}", with_flags(notice));
  return motion;
}

}  // namespace mcdbn::cli
