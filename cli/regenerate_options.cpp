#include "regenerate_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "fit_option.hpp"
#include "mcdbn/base/errors.hpp"
#include "output_ending.hpp"

namespace mcdbn::cli {
namespace {

/// An option, by its flag, and whether it was given.
struct GivenFlag {
  bool given;
  const char* flag;
};

/// The first that was given; null if none was.
const char* first_given(std::initializer_list<GivenFlag> flags) {
  const auto* const found = std::ranges::find_if(flags, &GivenFlag::given);
  return found == flags.end() ? nullptr : found->flag;
}

/// Options that mean nothing where a track is wanted, or where motion is. @throws ConfigError
/// naming the first
void check_direction(const RegenerateOptions& options) {
  if (options.to != kToTrack) {
    if (options.keep_first_frame) throw ConfigError("--keep-first-frame is for --to track");
    return;
  }
  const AssumedView& view = options.seen_by.view;
  const TrackReadOptions& track = options.track;
  if (const char* flag = first_given({{!options.skeleton.empty(), "--skeleton"},
                                      {!options.joint_map.empty(), "--joint-map"},
                                      {options.method != kModel, "--method"},
                                      {!options.write_camera.empty(), "--write-camera"},
                                      {!options.uncertainty.empty(), "--uncertainty"},
                                      {!options.fit.empty(), "--fit"},
                                      {view.pitch_deg.has_value(), "--camera-pitch"},
                                      {view.roll_deg.has_value(), "--camera-roll"},
                                      {view.field_of_view_deg.has_value(), "--camera-fov"},
                                      {!track.format.empty(), "--format"},
                                      {track.person != TrackReadOptions{}.person, "--person"},
                                      {track.fps.has_value(), "--fps"},
                                      {track.image_size.has_value(), "--image-size"}}))
    throw ConfigError(fmt::format(
        "{} is for --to pose: with --to track motion is read; the track has no skeleton and is "
        "not fitted, its rate is the model's, and its camera the model's or a file's",
        flag));
}

/// Refuses --uncertainty of several samples. @throws ConfigError
void check_uncertainty(const RegenerateOptions& options) {
  if (options.uncertainty.empty()) return;
  if (options.sampling.samples.value_or(1) > 1)
    throw ConfigError("--uncertainty is that of a single answer: leave out --samples");
}

/// Refuses to draw answers of a simpler method, which has only one. @throws ConfigError
void check_method(const RegenerateOptions& options) {
  if (options.method == kModel) return;
  if (const char* flag = options.sampling.drawing_flag())
    throw ConfigError(
        fmt::format("{} is for --method model: {} gives a single answer", flag, options.method));
}

/// Refuses options that --follow excludes or that need it; only it needs no --input and no -o.
/// @throws ConfigError naming the first
void check_follow(const RegenerateOptions& options) {
  const FollowOptions& following = options.following;
  if (!following.follow) {
    if (options.input.empty() || options.output.empty())
      throw ConfigError(fmt::format("{} is required", options.input.empty() ? "--input" : "-o"));
    if (following.look_ahead || !following.frames.empty())
      throw ConfigError("--look-ahead and --frames are for --follow");
    return;
  }
  const char* const drawing = options.sampling.drawing_flag();
  if (const char* flag = first_given({{options.to == kToTrack, "--to track"},
                                      {options.method != kModel, "--method"},
                                      {!options.write_camera.empty(), "--write-camera"},
                                      {!options.uncertainty.empty(), "--uncertainty"},
                                      {drawing != nullptr, drawing},
                                      {!track_fit(options.fit), "--fit none"}}))
    throw ConfigError(fmt::format("{} needs the whole track: leave it out, or --follow", flag));
}

/// Refuses outputs that are named as other formats than what is written. @throws ConfigError
void check_output_endings(const RegenerateOptions& options) {
  if (options.following.follow)
    check_frames_output(options.output, options.following);
  else
    check_ending(options.output, {options.to == kToTrack ? ".csv" : ".bvh"});
  check_camera_output(options.write_camera);
}

}  // namespace

void check_options(const RegenerateOptions& options) {
  check_direction(options);
  check_uncertainty(options);
  check_method(options);
  check_follow(options);
  check_output_endings(options);
}

}  // namespace mcdbn::cli
