#include "comparison/twin_gaussian_processes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/interruption.hpp"
#include "comparison/clip_pairs.hpp"
#include "comparison/lbfgs.hpp"
#include "comparison/track_window.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using Eigen::VectorXd;

/// Root mean square distance of two rows.
double spread_of(const MatrixF& rows) {
  const MatrixD centered =
      rows.cast<double>().rowwise() - RowVectorD(rows.cast<double>().colwise().mean());
  const double square = 2.0 * centered.squaredNorm() / static_cast<double>(rows.rows());
  return square > 0 ? std::sqrt(square) : 1.0;
}

Eigen::LLT<Eigen::MatrixXd> factor(const MatrixD& kernel) {
  Eigen::LLT<Eigen::MatrixXd> result{Eigen::MatrixXd(kernel)};
  if (result.info() != Eigen::Success)
    throw Error("twin_gaussian_process: the tracks or poses hold values that are not finite");
  return result;
}

}  // namespace

VectorXd TwinGaussianProcess::Kernel::against(const MatrixD& rows, const VectorXd& one) const {
  const VectorXd squares = (rows.rowwise() - one.transpose()).rowwise().squaredNorm();
  return (-squares.array() / (2 * width * width)).exp();
}

MatrixD TwinGaussianProcess::Kernel::among(const MatrixD& rows) const {
  const VectorXd squares = rows.rowwise().squaredNorm();
  MatrixD distances = -2.0 * rows * rows.transpose();
  distances.colwise() += squares;
  distances.rowwise() += squares.transpose();
  MatrixD kernel = (-distances.array().max(0.0) / (2 * width * width)).exp();
  kernel.diagonal().setConstant(1 + noise);
  return kernel;
}

TwinGaussianProcess::TwinGaussianProcess(const MatrixD& windows, const MatrixD& poses,
                                         const Kernel& track, const Kernel& pose,
                                         const VectorXd& window)
    : poses_(poses), pose_kernel_(pose), pose_factor_(factor(pose.among(poses))) {
  const VectorXd similarity = track.against(windows, window);
  u_ = factor(track.among(windows)).solve(similarity);
  eta_ = 1 + track.noise - similarity.dot(u_);
}

double TwinGaussianProcess::divergence(const VectorXd& pose, VectorXd& gradient) const {
  const VectorXd similarity = pose_kernel_.against(poses_, pose);
  const VectorXd explained = pose_factor_.solve(similarity);
  const double self = 1 + pose_kernel_.noise;
  const double left = self - similarity.dot(explained);
  // By each entry of the similarity, whose own gradient is similarity · (pose_i − pose) / width².
  const VectorXd by_similarity =
      ((-2.0 * u_ + 2.0 * eta_ / left * explained).array() * similarity.array()) /
      (pose_kernel_.width * pose_kernel_.width);
  gradient = poses_.transpose() * by_similarity - by_similarity.sum() * pose;
  return self - 2.0 * u_.dot(similarity) - eta_ * std::log(left);
}

VectorXd TwinGaussianProcess::regression() const {
  const RowVectorD mean = poses_.colwise().mean();
  return ((poses_.rowwise() - mean).transpose() * u_) + mean.transpose();
}

TwinGaussianProcesses::TwinGaussianProcesses(const TwinGaussianProcessSettings& settings)
    : settings_(settings) {
  settings_.validate();
}

void TwinGaussianProcesses::fit(const std::vector<MatrixF>& tracks,
                                const std::vector<MatrixF>& poses) {
  WindowPairs pairs = window_pairs(tracks, poses);
  windows_ = std::move(pairs.windows);
  poses_ = std::move(pairs.poses);
  track_kernel_ = {settings_.track_width * spread_of(windows_), settings_.track_noise};
  pose_kernel_ = {settings_.pose_width * spread_of(poses_), settings_.pose_noise};
  track_dimension_ = tracks.front().cols();
}

std::vector<Eigen::Index> TwinGaussianProcesses::nearest(const RowVectorF& window) const {
  const Eigen::VectorXf squares = (windows_.rowwise() - window).rowwise().squaredNorm();
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(windows_.rows()));
  std::iota(rows.begin(), rows.end(), Eigen::Index{0});
  const auto count = std::min(settings_.neighbours, rows.size());
  const auto last = rows.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(rows.begin(), last, rows.end(), [&](Eigen::Index i, Eigen::Index j) {
    return squares(i) < squares(j) || (squares(i) == squares(j) && i < j);
  });
  rows.erase(last, rows.end());
  return rows;
}

MatrixF TwinGaussianProcesses::predict(const MatrixF& track) const {
  check_track(track, track_dimension_);
  const MatrixF windows = track_windows(track);
  LbfgsSettings search;
  search.steps = settings_.steps;
  MatrixF answers(track.rows(), poses_.cols());
  for (Eigen::Index t = 0; t < track.rows(); ++t) {
    check_interruption();
    const std::vector<Eigen::Index> rows = nearest(windows.row(t));
    const MatrixD near_windows = windows_(rows, Eigen::all).cast<double>();
    const MatrixD near_poses = poses_(rows, Eigen::all).cast<double>();
    const TwinGaussianProcess twin(near_windows, near_poses, track_kernel_, pose_kernel_,
                                   windows.row(t).transpose().cast<double>());
    const VectorXd pose = minimize_lbfgs(
        [&](const VectorXd& at, VectorXd& gradient) { return twin.divergence(at, gradient); },
        twin.regression(), search);
    answers.row(t) = pose.transpose().cast<float>();
  }
  return answers;
}

}  // namespace mcdbn
