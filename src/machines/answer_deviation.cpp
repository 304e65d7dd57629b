#include "mcdbn/machines/answer_deviation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// A residual smaller than this share of its column's RMS counts as that: the logarithm of a chance
/// zero would weigh more than all others.
constexpr double kSmallest = 0.02;
/// Frames whose codes are doubles at once: all of a corpus's would be most of a training's memory.
constexpr Eigen::Index kBlock = 4096;

}  // namespace

MatrixF AnswerDeviation::of(const MatrixF& code) const {
  if (code.cols() != C.rows())
    throw ShapeError("answer deviation: the code has another number of units");
  return ((code * C).rowwise() + c.row(0)).array().exp();
}

AnswerDeviation AnswerDeviation::fit(const MatrixF& code, const MatrixF& residuals) {
  if (code.rows() != residuals.rows() || code.rows() < 2)
    throw ShapeError("answer deviation: needs two frames and more, as many codes as residuals");
  const MatrixD squares = residuals.cast<double>().array().square();
  const RowVectorD mean_square =
      squares.colwise().mean().cwiseMax(std::numeric_limits<float>::min());
  const MatrixD logs =
      0.5 * squares.cwiseMax(kSmallest * kSmallest * mean_square.replicate(squares.rows(), 1))
                .array()
                .log();
  const RowVectorD mean_log = logs.colwise().mean(),
                   mean_code = code.cast<double>().colwise().mean();
  MatrixD normal = MatrixD::Identity(code.cols(), code.cols()),
          products = MatrixD::Zero(code.cols(), logs.cols());
  for (Eigen::Index first = 0; first < code.rows(); first += kBlock) {
    const Eigen::Index rows = std::min(kBlock, code.rows() - first);
    const MatrixD centered = code.middleRows(first, rows).cast<double>().rowwise() - mean_code;
    normal.noalias() += centered.transpose() * centered;
    products.noalias() +=
        centered.transpose() * (logs.middleRows(first, rows).rowwise() - mean_log);
  }
  const MatrixD slope = normal.llt().solve(products);
  AnswerDeviation deviation{slope.cast<float>(), (mean_log - mean_code * slope).cast<float>()};
  const MatrixD ratios = squares.array() / deviation.of(code).cast<double>().array().square();
  // Where every residual is 0 the logarithm would be infinite.
  const Eigen::ArrayXXd means = ratios.colwise().mean().array().max(kSmallest * kSmallest);
  deviation.c += (0.5 * means.log()).matrix().cast<float>();
  return deviation;
}

void AnswerDeviation::calibrate(const MatrixF& residuals, const MatrixF& deviations) {
  if (residuals.rows() != deviations.rows() || residuals.cols() != deviations.cols() ||
      residuals.size() == 0)
    throw ShapeError("answer deviation: calibration needs a deviation for each residual");
  const double ratio = (residuals.array() / deviations.array()).cast<double>().square().mean();
  c.array() += static_cast<float>(0.5 * std::log(ratio));
}

}  // namespace mcdbn
