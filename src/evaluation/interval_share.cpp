#include "mcdbn/evaluation/interval_share.hpp"

#include <limits>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

double share_within_90(const MatrixD& truth, const MatrixD& answer, const MatrixD& deviation) {
  const auto fits = [&](const MatrixD& other) {
    return other.rows() == truth.rows() && other.cols() == truth.cols();
  };
  if (!fits(answer) || !fits(deviation))
    throw ShapeError("share_within_90: answer and deviation are not of the truth's shape");
  if (truth.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto held = (truth - answer).array().abs() <= kReachOf90 * deviation.array();
  return static_cast<double>(held.count()) / static_cast<double>(truth.size());
}

}  // namespace mcdbn
