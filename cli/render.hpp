#pragma once

#include <filesystem>
#include <vector>

#include "camera_options.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "mcdbn/drawing/render.hpp"

namespace mcdbn::cli {

struct RenderCommandOptions {
  std::vector<std::filesystem::path> clips;
  std::filesystem::path output;
  CameraOptions camera;
  ClipOptions preparation;
  RenderOptions render;
};

/// Draws. mcdbn-cl replaces itself by a program of its own for it: OpenCV's films need two hundred
/// libraries, which would take every command a sixth of a second to load.
void run_render(const RenderCommandOptions& options, const CommandContext& context);

}  // namespace mcdbn::cli
