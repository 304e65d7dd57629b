#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/motion_model/live_regeneration.hpp"

namespace mcdbn::cli {

/// Options of regenerate --follow.
struct FollowOptions {
  bool follow = false;
  std::optional<std::size_t> look_ahead;
  std::string frames;  ///< bvh, csv, json; empty: by the output's ending
};

void add_follow_options(CLI::App& command, FollowOptions& options);

/// Refuses an output whose ending is that of no format of frames, where none is given.
/// @throws ConfigError
void check_frames_output(const std::filesystem::path& output, const FollowOptions& options);

/// Reads a track line by line and writes frames as they are finished, until the input ends or a
/// stop is requested; the frames in progress are then still written.
/// @param input "-": standard input  @param output empty: standard output
/// @throws InputError, ConfigError, as LiveRegeneration and TrackLines do
void follow_track(const Model& model, const std::filesystem::path& input,
                  const std::filesystem::path& output, const TrackReadOptions& reading,
                  const ClipPlacement& placement, const FollowOptions& options);

}  // namespace mcdbn::cli
