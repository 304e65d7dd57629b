#pragma once

#include "mcdbn/corpus/augmentation.hpp"

namespace mcdbn::test {

/// Settings with which a view is the clip as it was captured.
inline AugmentationSettings nothing() {
  AugmentationSettings settings;
  settings.mirror = false;
  settings.azimuth_deg = settings.elevation_deg = settings.distance = 0;
  settings.bone = settings.turn_deg = settings.speed = settings.noise_px = settings.missing = 0;
  return settings;
}

}  // namespace mcdbn::test
