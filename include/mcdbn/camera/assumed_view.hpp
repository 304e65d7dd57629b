#pragma once

#include <optional>

#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// Known angles of a camera without calibration; the others are assumed
/// (Modalities::assumed_camera).
struct AssumedView {
  static constexpr Range kPitch_deg = within(-89, 89), kRoll_deg = within(-180, 180);

  std::optional<double> pitch_deg;          ///< how far it looks down
  std::optional<double> roll_deg;           ///< turned clockwise, seen from behind it
  std::optional<double> field_of_view_deg;  ///< vertical
};

/// The vertical field of view of an image of that size whose longer side spans 60 degrees, the
/// middle of the 40 to 80 that phones, webcams and camcorders have without zoom.
double usual_field_of_view_deg(int width_px, int height_px);

}  // namespace mcdbn
