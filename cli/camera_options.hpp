#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "mcdbn/camera/assumed_view.hpp"
#include "mcdbn/camera/camera.hpp"

namespace mcdbn::cli {

/// The command line's camera: a file, or where to place one that looks at the clip.
struct CameraOptions {
  std::filesystem::path file;
  CameraPlacement placement;

  /// The camera for this clip. @throws InputError if the file cannot be read
  Camera camera_for(const Motion& motion) const;
};

/// What a command line gives of the camera that filmed a track.
struct SeenByOptions {
  std::filesystem::path file;  ///< FILE or FILE:NAME
  AssumedView view;            ///< of a camera without a file

  /// @throws InputError if the file cannot be read
  std::optional<Camera> camera() const;
};

/// A camera file's camera; warns what was assumed of it, and reports what its file states.
/// @throws InputError
Camera read_camera_with_notices(const std::filesystem::path& file);

/// The camera as it gives the track's images; warns where it is scaled to them.
/// @param name the track's, for messages  @throws InputError as of_scaled_images
Camera camera_of_track(const Camera& camera, const Track2d& track, const std::string& name);

/// --camera FILE[:NAME], or --camera-pitch, --camera-roll, --camera-fov.
void add_seen_by_options(CLI::App& command, SeenByOptions& options);

/// --camera FILE[:NAME], or --camera-azimuth, --camera-elevation, --camera-distance, --camera-fov,
/// --image-size.
void add_camera_options(CLI::App& command, CameraOptions& options);

/// --camera-azimuth and --camera-elevation; default: those that the model was trained with.
void add_view_flags(CLI::App& command, std::optional<double>& azimuth_deg,
                    std::optional<double>& elevation_deg);

}  // namespace mcdbn::cli
