#include "fitting/seen_noise.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/track_smoothing.hpp"

namespace mcdbn {
namespace {

constexpr double kHeight_m = 1.7;  ///< of the body that lengths are of
/// A solution's residual as a share of the noise that it was given, measured on detector-like
/// tracks of CMU walkers.
constexpr double kResidualOfNoise = 0.88;
/// The most noise that is taken for a detector's, as a multiple of the usual.
constexpr double kMost = 3;
/// The most noise that counts as exact, as a share of a detector's.
constexpr double kExact = 0.5;
/// The most noise that is new in every frame and counts as exact, as a share of a detector's. A
/// solution may be as far off an exact track as off a noisy one, but the track itself distinguishes
/// them.
constexpr double kExactOfTrack = 0.25;
/// A noise that changes by less is not worth another solution.
constexpr double kSmallChange = 0.1;

}  // namespace

SeenNoise::SeenNoise(double track_noise_px, const Camera& camera, double depth_m, bool may_be_exact,
                     const TrackFitSettings& settings, double share)
    : may_be_exact_(may_be_exact) {
  const double focal_px = std::sqrt(camera.fx_px * camera.fy_px);
  const auto on_rays = [&](double noise_px) {
    return std::max(kLeastNoise_px, noise_px) / focal_px;
  };
  of_track_ = on_rays(track_noise_px);
  usual_ = settings.detector_noise_heights * kHeight_m / std::max(depth_m, 1e-9);
  least_ = may_be_exact ? of_track_ : usual_;
  rays_.white = on_rays(settings.noise_factor * track_noise_px);
  rays_.steady = may_be_exact && rays_.white <= kExactOfTrack * usual_;
  measured_white_ = on_rays(settings.measured_noise_factor * track_noise_px);
  set_lasting(share * usual_);
}

bool SeenNoise::learn(double residual) {
  const double before = std::hypot(rays_.white, rays_.lasting);
  const double estimated = residual * residual / (kResidualOfNoise * kResidualOfNoise * before);
  const double both = std::clamp(estimated, least_, std::max({least_, of_track_, kMost * usual_}));
  set_lasting(std::sqrt(std::max(0.0, both * both - of_track_ * of_track_)));
  const double after = std::hypot(rays_.white, rays_.lasting);
  return std::abs(after - before) > kSmallChange * before;
}

bool SeenNoise::measure() {
  if (!may_be_exact_ || rays_.steady || rays_.measured) return false;
  rays_.measured = true;
  rays_.white = measured_white_;
  return true;
}

void SeenNoise::set_lasting(double lasting) {
  rays_.lasting = lasting;
  rays_.exact = rays_.steady && std::hypot(rays_.white, lasting) <= kExact * usual_;
}

}  // namespace mcdbn
