#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>

#include "mcdbn/base/matrices.hpp"

/// Bounds from rounding error analysis (Higham, "Accuracy and Stability of Numerical Algorithms",
/// chapter 3), for single precision against the double reference.
namespace mcdbn::reference {

/// Unit roundoff of float.
inline constexpr double kRoundoff = 0x1p-24;

/// γ_n = n·u / (1 − n·u): relative error of n rounded operations in a row.
inline double gamma_n(double operations) {
  return operations * kRoundoff / (1.0 - operations * kRoundoff);
}

/// Relative error of OpenCL's single-precision functions in the full profile, as multiples of u
/// (1 ulp is at most 2u): division 2.5 ulp, sqrt 3 ulp, log 3 ulp, cospi 4 ulp.
inline constexpr double kDivisionError = 5.0;
inline constexpr double kSqrtError = 6.0;
inline constexpr double kLogError = 6.0;
inline constexpr double kCospiError = 8.0;
/// The library's own exp (1 ulp) and, from it, 1 / (1 + exp(−x)).
inline constexpr double kExpError = 2.0;
inline constexpr double kSigmoidError = kExpError + 1.0 + kDivisionError;

/// Below this a float is subnormal, and a device may flush it to zero.
inline constexpr double kSmallestNormal = std::numeric_limits<float>::min();

/// Empty if |got − want| ≤ bound everywhere, else the first entry where that does not hold (a NaN
/// never fits).
template <typename Got, typename Want, typename Bound>
std::string misfit(const Eigen::MatrixBase<Got>& got, const Eigen::MatrixBase<Want>& want,
                   const Eigen::MatrixBase<Bound>& bound) {
  if (got.rows() != want.rows() || got.cols() != want.cols() || got.rows() != bound.rows() ||
      got.cols() != bound.cols())
    return fmt::format("shapes {}x{}, {}x{}, bound {}x{}", got.rows(), got.cols(), want.rows(),
                       want.cols(), bound.rows(), bound.cols());
  int count = 0;
  std::string first;
  for (Eigen::Index r = 0; r < got.rows(); ++r)
    for (Eigen::Index c = 0; c < got.cols(); ++c) {
      const double error = std::abs(static_cast<double>(got(r, c)) - want(r, c));
      if (!(error <= bound(r, c)) && count++ == 0)
        first = fmt::format("({}, {}): {:.9g} instead of {:.9g}, bound {:.3g}", r, c,
                            static_cast<double>(got(r, c)), want(r, c), bound(r, c));
    }
  return count == 0 ? "" : fmt::format("{} of {} entries, first {}", count, got.size(), first);
}

}  // namespace mcdbn::reference
