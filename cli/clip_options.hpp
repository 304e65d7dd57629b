#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "mcdbn/corpus/clip.hpp"

namespace mcdbn::cli {

/// --fps and --keep-first-frame.
void add_clip_options(CLI::App& command, ClipOptions& options);

void add_keep_first_frame_option(CLI::App& command, bool& keep_first_frame);

/// load_clip with its notices printed to stderr.
Motion load_clip_with_notices(const std::filesystem::path& path, const ClipOptions& options);

}  // namespace mcdbn::cli
