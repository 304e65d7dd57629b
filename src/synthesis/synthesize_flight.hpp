#pragma once

#include "synthesis/synthesize_rig.hpp"

namespace mcdbn::synthesis {

constexpr double kGravity = 981;  ///< cm/s²

/// A height in free fall from one value to another, cm and seconds.
struct Flight {
  double from, to, duration;

  double take_off_speed() const { return (to - from) / duration + kGravity * duration / 2; }
  double landing_speed() const { return take_off_speed() - kGravity * duration; }
  double at(double t) const { return from + take_off_speed() * t - kGravity * t * t / 2; }
};

/// Height of the hips over flat feet with all but straight legs.
inline double standing_height(const Body& body) {
  return body.straight_hips_height() - 0.6;
}

}  // namespace mcdbn::synthesis
