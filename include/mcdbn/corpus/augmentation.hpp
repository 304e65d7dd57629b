#pragma once

#include <cstddef>

#include "mcdbn/base/random.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// How far a view of a clip may be from the clip as it was captured: other people, other cameras,
/// other ways to hold oneself. Deviations are of normal draws, one a view unless it says otherwise.
struct AugmentationSettings {
  std::size_t views = 20;  ///< of each clip
  bool mirror = true;      ///< every other view, where the skeleton has sides
  double azimuth_deg = 0.0, elevation_deg = 0.0;  ///< the camera turns by up to so much
  double distance = 0.0;                          ///< relative deviation of the camera's distance
  double bone = 0.05;     ///< relative deviation of each bone's length, both sides alike
  double turn_deg = 2.0;  ///< each joint is held otherwise, throughout the clip
  double speed = 0.05;    ///< up to so much faster or slower
  double noise_px = 0.5;  ///< mean deviation of the 2D joints, up to twice as much in a view
  double missing = 0.3;   ///< share of the views in which limbs go out of sight (hide_limbs)
};

/// A view of a clip before scaling.
struct AugmentedView {
  Motion motion;  ///< at the model's rate
  Camera camera;
  Track2d track;
};

/// The clip seen otherwise. The same key gives the same view.
/// @param raw at its own rate
AugmentedView augmented_view(const Motion& raw, double fps, const CameraPlacement& placement,
                             const AugmentationSettings& settings, const RandomKey& key);

}  // namespace mcdbn
