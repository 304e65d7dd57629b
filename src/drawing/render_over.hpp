#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drawing/render_figure.hpp"
#include "mcdbn/drawing/render.hpp"

namespace mcdbn::rendering {

/// Figures drawn over the frames of a film (options.over), to .mp4 or .png, as render() does.
void render_over(const std::vector<Figure>& figures, const std::filesystem::path& path,
                 const RenderOptions& options, std::vector<std::string>* notices);

}  // namespace mcdbn::rendering
