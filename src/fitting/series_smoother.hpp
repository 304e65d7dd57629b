#pragma once

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// One number of a series with its variance; infinite where it was not measured.
struct Measured {
  double value = 0;
  double variance = 0;
};

/// How a number and its rate of change go on from one frame to the next.
struct SeriesDynamics {
  Eigen::Matrix2d start;  ///< covariance before anything was measured
  Eigen::Matrix2d step;   ///< of the mean
  Eigen::Matrix2d noise;  ///< covariance that a step adds

  /// With a velocity that white acceleration of that spectral density changes: what is not measured
  /// becomes a cubic spline.
  static SeriesDynamics with_velocity(double density, double frame_time_s);
};

/// Each number of a series estimated from the whole of it: a Kalman filter, and the
/// Rauch-Tung-Striebel smoother back. Outliers count little (Cauchy's weights).
std::vector<Measured> smooth_series(const std::vector<Measured>& series,
                                    const SeriesDynamics& dynamics);

/// An estimate without one of the measurements that went into it.
Measured without(const Measured& whole, const Measured& part);

}  // namespace mcdbn
