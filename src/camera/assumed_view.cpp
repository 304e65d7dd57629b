#include "mcdbn/camera/assumed_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mcdbn {

double usual_field_of_view_deg(int width_px, int height_px) {
  constexpr double kLongerSide_deg = 60, kHalf_rad = std::numbers::pi / 360;
  const double share = static_cast<double>(height_px) / std::max(width_px, height_px);
  return std::atan(share * std::tan(kLongerSide_deg * kHalf_rad)) / kHalf_rad;
}

}  // namespace mcdbn
