#pragma once

#include <filesystem>
#include <vector>

#include "drawing/render_figure.hpp"
#include "mcdbn/drawing/render.hpp"

namespace mcdbn::rendering {

/// Figures drawn over the frames of a film (options.over), to .mp4 or .png, as render() does.
void render_over(const std::vector<Figure>& figures, const std::filesystem::path& path,
                 const RenderOptions& options);

}  // namespace mcdbn::rendering
