#pragma once

#include <filesystem>
#include <string>

#include "camera_options.hpp"
#include "follow.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "sampling_options.hpp"

namespace mcdbn::cli {

inline constexpr const char *kToPose = "pose", *kToTrack = "track", *kModel = "model";

/// Options of regenerate.
struct RegenerateOptions {
  std::filesystem::path model, input, output, skeleton, joint_map, write_camera, uncertainty;
  TrackReadOptions track;
  SeenByOptions seen_by;
  SamplingOptions sampling;
  std::string to = kToPose, fit, method = kModel;
  bool keep_first_frame = false;
  FollowOptions following;
};

/// Refuses options that exclude each other or would be ignored, and outputs whose endings are those
/// of other formats, before any work. @throws ConfigError naming the first
void check_options(const RegenerateOptions& options);

}  // namespace mcdbn::cli
