#include "comparison/ridge_window.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "base/missing_values.hpp"
#include "comparison/clip_pairs.hpp"
#include "comparison/track_window.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

constexpr Eigen::Index kBlock = 2048;  ///< window rows held at a time
constexpr int kFolds = 5;
constexpr std::array kPenalties = {1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0};

/// Rows first … first + count − 1 of the regression's input.
/// @param track [frames x d2], no NaN  @return [count x kWindowFrames·d2 + 1], the last column is 1
MatrixD windows(const MatrixF& track, Eigen::Index first, Eigen::Index count) {
  MatrixD rows(count, kWindowFrames * track.cols() + 1);
  rows.leftCols(kWindowFrames * track.cols()) = track_windows(track, first, count).cast<double>();
  rows.rightCols<1>().setOnes();
  return rows;
}

/// All that least squares needs to know of some frames; sums over disjoint frames add up.
struct Moments {
  MatrixD gram;   ///< Σ xᵀx, lower triangle
  MatrixD cross;  ///< Σ xᵀy
  double frames = 0;

  Moments(Eigen::Index inputs, Eigen::Index outputs)
      : gram(MatrixD::Zero(inputs, inputs)), cross(MatrixD::Zero(inputs, outputs)) {}

  void add(const MatrixF& track, const MatrixF& pose, Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index first = begin; first < end; first += kBlock) {
      const Eigen::Index count = std::min(kBlock, end - first);
      const MatrixD x = windows(track, first, count);
      gram.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
      cross.noalias() += x.transpose() * pose.middleRows(first, count).cast<double>();
    }
    frames += static_cast<double>(end - begin);
  }

  void add(const Moments& other) {
    gram += other.gram;
    cross += other.cross;
    frames += other.frames;
  }

  /// Least squares with `penalty`·frames·‖coefficients‖², the bias left out of it.
  MatrixD solve(double penalty) const {
    MatrixD penalised = gram;
    penalised.diagonal().head(gram.rows() - 1).array() += penalty * frames;
    const Eigen::LLT<Eigen::MatrixXd> factor(
        Eigen::MatrixXd(penalised.selfadjointView<Eigen::Lower>()));
    if (factor.info() != Eigen::Success)
      throw Error("ridge_window: the tracks or poses hold values that are not finite");
    return factor.solve(cross);
  }

  /// Squared error of coefficients on these frames, but for a constant that they do not change.
  double error(const MatrixD& coefficients) const {
    const MatrixD image = gram.selfadjointView<Eigen::Lower>() * coefficients;
    return (coefficients.array() * (image - 2.0 * cross).array()).sum();
  }
};

/// Frames in folds of clips that stand together, as one person's clips mostly do: the penalty has
/// to suit people who were not trained on. Fewer clips than folds are cut into that many pieces.
std::vector<Moments> folds(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  const Eigen::Index inputs = kWindowFrames * tracks[0].cols() + 1;
  std::vector<Moments> result(kFolds, Moments(inputs, poses[0].cols()));
  const std::size_t clips = tracks.size();
  for (std::size_t clip = 0; clip < clips; ++clip) {
    const MatrixF track = at_mean_where_unknown(tracks[clip]);
    if (clips >= kFolds) {
      result[clip * kFolds / clips].add(track, poses[clip], 0, track.rows());
      continue;
    }
    for (int piece = 0; piece < kFolds; ++piece)
      result[static_cast<std::size_t>(piece)].add(track, poses[clip], piece * track.rows() / kFolds,
                                                  (piece + 1) * track.rows() / kFolds);
  }
  return result;
}

double cross_validated_penalty(const std::vector<Moments>& parts) {
  std::array<double, kPenalties.size()> errors{};
  for (std::size_t held_out = 0; held_out < parts.size(); ++held_out) {
    Moments rest(parts[0].gram.rows(), parts[0].cross.cols());
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (part != held_out) rest.add(parts[part]);
    if (rest.frames == 0 || parts[held_out].frames == 0) continue;
    for (std::size_t i = 0; i < kPenalties.size(); ++i)
      errors[i] += parts[held_out].error(rest.solve(kPenalties[i]));
  }
  const auto best = std::min_element(errors.begin(), errors.end());
  return kPenalties[static_cast<std::size_t>(best - errors.begin())];
}

}  // namespace

void RidgeWindow::fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  check_clip_pairs(tracks, poses);
  const std::vector<Moments> parts = folds(tracks, poses);
  penalty_ = cross_validated_penalty(parts);
  Moments all(parts[0].gram.rows(), parts[0].cross.cols());
  for (const Moments& part : parts) all.add(part);
  coefficients_ = all.solve(penalty_);
}

MatrixF RidgeWindow::predict(const MatrixF& track) const {
  check_track(track, coefficients_.size() ? (coefficients_.rows() - 1) / kWindowFrames : 0);
  const MatrixF input = at_mean_where_unknown(track);
  MatrixF output(input.rows(), coefficients_.cols());
  for (Eigen::Index first = 0; first < input.rows(); first += kBlock) {
    const Eigen::Index count = std::min(kBlock, input.rows() - first);
    output.middleRows(first, count) = (windows(input, first, count) * coefficients_).cast<float>();
  }
  return output;
}

}  // namespace mcdbn
