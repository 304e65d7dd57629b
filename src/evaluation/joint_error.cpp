#include "mcdbn/evaluation/joint_error.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "evaluation/procrustes.hpp"
#include "evaluation/relative_to_root.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr double kCorrectWithin_mm = 150.0;

/// Length of every joint's 3-vector. @param vectors [frames x 3·joints]  @return [frames x joints]
MatrixD joint_norms(const MatrixD& vectors) {
  MatrixD norms(vectors.rows(), vectors.cols() / 3);
  for (Eigen::Index joint = 0; joint < norms.cols(); ++joint)
    norms.col(joint) = vectors.middleCols<3>(3 * joint).rowwise().norm();
  return norms;
}

MatrixD without_column(const MatrixD& values, Eigen::Index column) {
  MatrixD kept(values.rows(), values.cols() - 1);
  kept << values.leftCols(column), values.rightCols(values.cols() - 1 - column);
  return kept;
}

/// Change from frame to frame, per second. One row fewer.
MatrixD rate_of_change(const MatrixD& values, double fps) {
  return (values.bottomRows(values.rows() - 1) - values.topRows(values.rows() - 1)) * fps;
}

double mean_or_nan(const MatrixD& values) {
  return values.size() ? values.mean() : std::numeric_limits<double>::quiet_NaN();
}

void check(const MatrixD& truth, const MatrixD& regenerated, int root_joint) {
  if (truth.rows() != regenerated.rows() || truth.cols() != regenerated.cols() ||
      truth.rows() == 0 || truth.cols() % 3 != 0 || truth.cols() < 6)
    throw ShapeError(fmt::format(
        "cannot compare positions of {}x{} and {}x{}: frames x 3 a joint are needed, for two "
        "joints or more",
        truth.rows(), truth.cols(), regenerated.rows(), regenerated.cols()));
  if (root_joint < 0 || 3 * root_joint >= truth.cols())
    throw ShapeError(
        fmt::format("there is no root joint {} in {} joints", root_joint, truth.cols() / 3));
}

/// Lengths of joint vectors but the root's. @return [frames x joints − 1]
MatrixD body_norms(const MatrixD& vectors, int root_joint) {
  return without_column(joint_norms(vectors), root_joint);
}

}  // namespace

double mean_joint_distance_mm(const MatrixD& truth, const MatrixD& regenerated, int root_joint) {
  check(truth, regenerated, root_joint);
  return body_norms(relative_to_root(regenerated - truth, root_joint), root_joint).mean();
}

JointError joint_error(const MatrixD& truth, const MatrixD& regenerated, double fps,
                       int root_joint) {
  check(truth, regenerated, root_joint);
  const MatrixD target = relative_to_root(truth, root_joint);
  const MatrixD source = relative_to_root(regenerated, root_joint);
  const MatrixD difference = source - target;
  MatrixD residual(target.rows(), target.cols());
  for (Eigen::Index frame = 0; frame < target.rows(); ++frame)
    residual.row(frame) = procrustes_residual(target.row(frame), source.row(frame));

  const MatrixD distance = body_norms(difference, root_joint);
  JointError error;
  error.mpjpe_mm = distance.mean();
  error.pa_mpjpe_mm = body_norms(residual, root_joint).mean();
  error.rmse_mm = std::sqrt(distance.array().square().mean());
  error.pck_150mm = (distance.array() <= kCorrectWithin_mm).cast<double>().mean();
  const MatrixD velocity = rate_of_change(difference, fps);
  error.mpjve_mm_s = mean_or_nan(body_norms(velocity, root_joint));
  error.acceleration_error_mm_s2 =
      velocity.rows() ? mean_or_nan(body_norms(rate_of_change(velocity, fps), root_joint))
                      : std::numeric_limits<double>::quiet_NaN();
  return error;
}

}  // namespace mcdbn
