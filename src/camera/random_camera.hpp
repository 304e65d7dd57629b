#pragma once

#include <cstdint>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// Where people stand with a camera: drawn anew for each clip, all around the person, alike between
/// the bounds. The azimuth is any.
struct DetectorCameras {
  double elevation_from_deg = -10, elevation_to_deg = 35;
  double roll_deg = 8;
  double fov_from_deg = 35, fov_to_deg = 70;
  double distance_from_m = 2.5, distance_to_m = 8;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"elevation-from", within(-89, 89), "degrees", "elevation of the lowest camera"},
          self.elevation_from_deg);
    visit(Setting{"elevation-to", within(-89, 89), "degrees", "elevation of the highest camera"},
          self.elevation_to_deg);
    visit(Setting{"roll", within(0, 180), "degrees",
                  "standard deviation of the camera's turn about its viewing axis: hand-held, or a "
                  "tripod that is not level"},
          self.roll_deg);
    visit(Setting{"fov-from", CameraPlacement::kFieldOfView_deg, "degrees",
                  "smallest vertical field of view"},
          self.fov_from_deg);
    visit(Setting{"fov-to", CameraPlacement::kFieldOfView_deg, "degrees",
                  "largest vertical field of view"},
          self.fov_to_deg);
    visit(Setting{"distance-from", above(0, 1000), "m",
                  "smallest distance from the middle of the clip, for a body of 1.7 m; larger "
                  "where the clip would not fit in view"},
          self.distance_from_m);
    visit(Setting{"distance-to", above(0, 1000), "m", "largest distance, likewise"},
          self.distance_to_m);
  }
};

/// A camera that looks at the middle of the clip, with every joint of every frame in view. The same
/// seed gives the same.
/// @throws InputError if the clip has no frames, ConfigError if a setting is out of range
Camera random_camera(const Motion& motion, const DetectorCameras& settings, std::uint64_t seed);

}  // namespace mcdbn
