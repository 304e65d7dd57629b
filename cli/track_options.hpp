#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "mcdbn/formats/track_file.hpp"

namespace mcdbn::cli {

/// --format, --person, --fps and --image-size, for every command that reads a track.
void add_track_options(CLI::App& command, TrackReadOptions& options);

/// The names of track_formats(), for a help text.
std::string track_format_names();

/// read_tracks with its notices printed to stderr.
TrackReading read_tracks_with_notices(const std::filesystem::path& path,
                                      const TrackReadOptions& options);

}  // namespace mcdbn::cli
