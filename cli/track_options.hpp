#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "mcdbn/formats/track_file.hpp"

namespace mcdbn::cli {

/// --format, --person, --fps and --image-size, for every command that reads a track.
/// @param options its person is the default that the help names
void add_track_options(CLI::App& command, TrackReadOptions& options);

/// --format, a name of track_formats(). @param help ends with their list
CLI::Option* add_format_option(CLI::App& command, std::string& format, const std::string& help);

/// read_tracks with its notices printed to stderr.
TrackReading read_tracks_with_notices(const std::filesystem::path& path,
                                      const TrackReadOptions& options);

}  // namespace mcdbn::cli
