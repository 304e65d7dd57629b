#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "mcdbn/camera/camera.hpp"

namespace mcdbn::cli {

/// The camera as a command line says it: a file, or where to place one that looks at the clip.
struct CameraOptions {
  std::filesystem::path file;
  CameraPlacement placement;

  /// The camera for this clip. @throws InputError if the file cannot be read
  Camera camera_for(const Motion& motion) const;
};

/// --camera FILE, or --camera-azimuth, --camera-elevation, --camera-distance, --camera-fov,
/// --image-size.
void add_camera_options(CLI::App& command, CameraOptions& options);

/// --camera-azimuth and --camera-elevation, which are as the model was trained if nobody says them.
void add_view_flags(CLI::App& command, std::optional<double>& azimuth_deg,
                    std::optional<double>& elevation_deg);

}  // namespace mcdbn::cli
