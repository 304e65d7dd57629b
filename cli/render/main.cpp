// mcdbn-cl render, a program of its own: see run_render.
#include <spdlog/spdlog.h>

#include <array>

#include "render.hpp"
#include "run_program.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {

void run_render(const RenderCommandOptions& options, const CommandContext&) {
  std::vector<RenderClip> clips;
  for (const std::filesystem::path& path : options.clips) {
    clips.push_back({load_clip_with_notices(path, options.preparation), path.filename().string()});
  }
  RenderOptions look = options.render;
  look.placement = options.camera.placement;
  if (!options.camera.file.empty()) look.camera = options.camera.camera_for(clips.front().motion);
  std::vector<std::string> notices;
  render(clips, options.output, look, &notices);
  for (const std::string& notice : notices) spdlog::warn("{}", with_flags(notice));
  spdlog::info("{}: {} {}", options.output.string(), clips.size(),
               clips.size() == 1 ? "clip" : "clips");
}

}  // namespace mcdbn::cli

int main(int argc, char** argv) {
  constexpr std::array<mcdbn::cli::AddCommand, 1> kCommands = {mcdbn::cli::add_render_command};
  return mcdbn::cli::run_program(argc, argv, kCommands);
}
