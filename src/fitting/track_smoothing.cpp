#include "fitting/track_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/robust_residuals.hpp"
#include "fitting/series_smoother.hpp"

namespace mcdbn {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::infinity();
/// Independent noise of variance 1 in second and in third differences: sums of squared binomials.
constexpr double kSecondGain = 6, kThirdGain = 20;
/// Least noise, for a track made by projection, which is exact: the smoother divides by it.
constexpr double kLeastSmoothed_px = 0.05;

bool seen(const Track2d& track, Eigen::Index frame, Eigen::Index joint) {
  return track.confidence(frame, joint) > 0 && std::isfinite(track.x_px(frame, joint)) &&
         std::isfinite(track.y_px(frame, joint));
}

/// Frames from which on `count` in a row show the joint.
std::vector<Eigen::Index> runs(const Track2d& track, Eigen::Index joint, int count) {
  std::vector<Eigen::Index> starts;
  int in_a_row = 0;
  for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
    in_a_row = seen(track, frame, joint) ? in_a_row + 1 : 0;
    if (in_a_row >= count) starts.push_back(frame - count + 1);
  }
  return starts;
}

/// Spectral density of a coordinate's acceleration: integrated over a frame twice it leaves 2/3 of
/// density·time³ in second differences, beside the noise. Each counts by the noise that its
/// confidences leave in it, so that a keypoint that lies astray is not taken for motion.
double acceleration_density(const Track2d& track, const MatrixD& coordinate_px, Eigen::Index joint,
                            double noise_px) {
  double squares = 0, weights = 0;
  const auto starts = runs(track, joint, 3);
  for (const Eigen::Index t : starts) {
    const double second =
        coordinate_px(t + 2, joint) - 2 * coordinate_px(t + 1, joint) + coordinate_px(t, joint);
    const auto variance = [&](Eigen::Index frame) { return 1 / track.confidence(frame, joint); };
    const double weight = kSecondGain / (variance(t) + 4 * variance(t + 1) + variance(t + 2));
    squares += weight * second * second;
    weights += weight;
  }
  const double noise = kSecondGain * noise_px * noise_px;
  const double mean = weights > 0 ? squares / weights : 0;
  return 1.5 * std::max(mean - noise, 0.05 * noise) * std::pow(track.fps, 3);
}

}  // namespace

double track_noise_px(const Track2d& track) {
  std::vector<double> thirds;
  for (Eigen::Index joint = 0; joint < track.joint_count(); ++joint) {
    for (const Eigen::Index t : runs(track, joint, 4)) {
      for (const MatrixD* px : {&track.x_px, &track.y_px}) {
        thirds.push_back((*px)(t + 3, joint) - 3 * (*px)(t + 2, joint) + 3 * (*px)(t + 1, joint) -
                         (*px)(t, joint));
      }
    }
  }
  return robust_deviation(std::move(thirds)) / std::sqrt(kThirdGain);
}

Track2d smooth_track(const Track2d& track) {
  Track2d result = track;
  const double noise_px = std::max(kLeastSmoothed_px, track_noise_px(track));
  for (Eigen::Index joint = 0; joint < track.joint_count(); ++joint) {
    const std::vector<Eigen::Index> known = runs(track, joint, 1);
    for (MatrixD* coordinate_px : {&result.x_px, &result.y_px}) {
      std::vector<Measured> series(static_cast<std::size_t>(track.frames()), {0, kUnseen});
      for (const Eigen::Index t : known) {
        series[t] = {(*coordinate_px)(t, joint), noise_px * noise_px / track.confidence(t, joint)};
      }
      const double density = acceleration_density(track, *coordinate_px, joint, noise_px);
      series = smooth_series(series, SeriesDynamics::with_velocity(density, 1 / track.fps));
      for (const Eigen::Index t : known) (*coordinate_px)(t, joint) = series[t].value;
    }
  }
  return result;
}

}  // namespace mcdbn
