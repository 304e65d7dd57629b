#include "comparison/twin_gaussian_processes.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "comparison/clips.hpp"
#include "comparison/constant_pose.hpp"
#include "comparison/lbfgs.hpp"
#include "comparison/track_window.hpp"
#include "mcdbn/base/errors.hpp"

namespace twin_gaussian_processes_test {

using namespace mcdbn;
using namespace mcdbn::test;
using Eigen::VectorXd;

namespace {

using Kernel = TwinGaussianProcess::Kernel;

double kernel_of(const VectorXd& x, const VectorXd& y, double width) {
  return std::exp(-(x - y).squaredNorm() / (2 * width * width));
}

MatrixD gram(const MatrixD& rows, const Kernel& kernel) {
  MatrixD result(rows.rows(), rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    for (Eigen::Index j = 0; j < rows.rows(); ++j)
      result(i, j) =
          kernel_of(rows.row(i), rows.row(j), kernel.width) + (i == j ? kernel.noise : 0.0);
  return result;
}

/// All but ½ and constants of KL(N(0, K_r ∪ r) ‖ N(0, K_x ∪ x)), from the formula of the paper with
/// inverses written out.
double divergence(const MatrixD& windows, const MatrixD& poses, const Kernel& track,
                  const Kernel& pose, const VectorXd& window, const VectorXd& at) {
  VectorXd kx(windows.rows()), kr(poses.rows());
  for (Eigen::Index i = 0; i < windows.rows(); ++i) {
    kx(i) = kernel_of(windows.row(i), window, track.width);
    kr(i) = kernel_of(poses.row(i), at, pose.width);
  }
  const VectorXd u = gram(windows, track).inverse() * kx;
  const double eta = 1 + track.noise - kx.dot(u);
  const double left = 1 + pose.noise - kr.dot(gram(poses, pose).inverse() * kr);
  return 1 + pose.noise - 2 * u.dot(kr) - eta * std::log(left);
}

struct Problem {
  MatrixD windows = random_clip(9, 5, 1).cast<double>(),
          poses = random_clip(9, 4, 2).cast<double>();
  Kernel track{2.5, 0.02}, pose{1.8, 0.05};
  VectorXd window = random_clip(1, 5, 3).row(0).transpose().cast<double>();
  VectorXd at = random_clip(1, 4, 4).row(0).transpose().cast<double>();
  TwinGaussianProcess twin{windows, poses, track, pose, window};
};

/// A pose that no linear map of the track gives.
MatrixF bent_pose(const MatrixF& track) {
  MatrixF pose(track.rows(), 2);
  pose.col(0) = track.col(0).cwiseAbs();
  pose.col(1) = track.col(0).cwiseProduct(track.col(1));
  return pose;
}

/// A walk round a curve, so that windows differ little from frame to frame.
MatrixF smooth_track(int frames, float phase) {
  MatrixF track(frames, 2);
  for (int t = 0; t < frames; ++t) {
    const float at = 0.13F * static_cast<float>(t) + phase;
    track.row(t) << 1.4F * std::sin(at), 1.2F * std::cos(0.7F * at);
  }
  return track;
}

double error_of(const MatrixF& got, const MatrixF& want) {
  return static_cast<double>((got - want).squaredNorm()) / static_cast<double>(want.size());
}

}  // namespace

TEST_CASE("twin_gaussian_process: the divergence is the paper's, whatever the pose") {
  const Problem problem;
  VectorXd gradient;
  for (const VectorXd& at : {problem.at, VectorXd(problem.poses.row(3)), VectorXd(5 * problem.at)})
    CHECK(problem.twin.divergence(at, gradient) ==
          doctest::Approx(divergence(problem.windows, problem.poses, problem.track, problem.pose,
                                     problem.window, at))
              .epsilon(1e-10));
}

TEST_CASE("twin_gaussian_process: the gradient is that of finite differences") {
  const Problem problem;
  VectorXd gradient, unused;
  problem.twin.divergence(problem.at, gradient);
  for (Eigen::Index d = 0; d < 4; ++d) {
    const double step = 1e-5;
    VectorXd up = problem.at, down = problem.at;
    up(d) += step;
    down(d) -= step;
    const double slope =
        (problem.twin.divergence(up, unused) - problem.twin.divergence(down, unused)) / (2 * step);
    // Third derivatives here are of the order of 1, values rounded at 1e-15: error 1e-10.
    CHECK(std::abs(gradient(d) - slope) < 1e-8);
  }
}

TEST_CASE("twin_gaussian_process: the start is Gaussian process regression") {
  const Problem problem;
  VectorXd kx(9);
  for (Eigen::Index i = 0; i < 9; ++i)
    kx(i) = kernel_of(problem.windows.row(i), problem.window, problem.track.width);
  const RowVectorD mean = problem.poses.colwise().mean();
  const VectorXd want = (problem.poses.rowwise() - mean).transpose() *
                            gram(problem.windows, problem.track).inverse() * kx +
                        mean.transpose();
  CHECK((problem.twin.regression() - want).norm() < 1e-10);
}

TEST_CASE("twin_gaussian_process: a frame's answer is its problem's minimum, from its neighbours") {
  const std::vector<MatrixF> tracks = {smooth_track(40, 0), smooth_track(30, 2)};
  const std::vector<MatrixF> poses = {bent_pose(tracks[0]), bent_pose(tracks[1])};
  TwinGaussianProcessSettings settings;
  settings.neighbours = 12;
  settings.track_width = 0.7;
  settings.pose_width = 0.6;
  settings.track_noise = 0.01;
  settings.pose_noise = 0.02;
  settings.steps = 7;
  TwinGaussianProcesses baseline(settings);
  baseline.fit(tracks, poses);
  const MatrixF unseen = smooth_track(6, 0.77F), got = baseline.predict(unseen);

  const WindowPairs all = window_pairs(tracks, poses);
  const auto spread = [](const MatrixF& rows) {  // over all pairs, those of a row with itself too
    double sum = 0;
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      sum += (rows.rowwise() - rows.row(i)).rowwise().squaredNorm().cast<double>().sum();
    return std::sqrt(sum / static_cast<double>(rows.rows() * rows.rows()));
  };
  const Kernel track{0.7 * spread(all.windows), 0.01}, pose{0.6 * spread(all.poses), 0.02};
  const MatrixF windows = track_windows(unseen);
  for (Eigen::Index t = 0; t < 6; ++t) {
    std::vector<std::pair<float, Eigen::Index>> distances;
    for (Eigen::Index i = 0; i < all.windows.rows(); ++i)
      distances.emplace_back((all.windows.row(i) - windows.row(t)).squaredNorm(), i);
    std::sort(distances.begin(), distances.end());
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < 12; ++i) rows.push_back(distances[i].second);
    const MatrixD near_windows = all.windows(rows, Eigen::all).cast<double>();
    const MatrixD near_poses = all.poses(rows, Eigen::all).cast<double>();
    const VectorXd window = windows.row(t).transpose().cast<double>();
    const TwinGaussianProcess twin(near_windows, near_poses, track, pose, window);
    LbfgsSettings search;
    search.steps = 7;
    const VectorXd want = minimize_lbfgs(
        [&](const VectorXd& at, VectorXd& gradient) { return twin.divergence(at, gradient); },
        twin.regression(), search);
    CHECK((got.row(t).transpose().cast<double>() - want).norm() < 1e-4);
    VectorXd unused;
    CHECK(twin.divergence(want, unused) < twin.divergence(twin.regression(), unused));
  }
}

TEST_CASE("twin_gaussian_process learns what no linear map can, and carries it to another clip") {
  const std::vector<MatrixF> tracks = {smooth_track(120, 0), smooth_track(120, 5)};
  const std::vector<MatrixF> poses = {bent_pose(tracks[0]), bent_pose(tracks[1])};
  TwinGaussianProcesses baseline;
  CHECK(baseline.name() == "twin_gaussian_process");
  baseline.fit(tracks, poses);
  const MatrixF unseen = smooth_track(50, 2.3F), want = bent_pose(unseen);
  ConstantPose constant;
  constant.fit(tracks, poses);
  CHECK(error_of(baseline.predict(unseen), want) < 0.05 * error_of(constant.predict(unseen), want));
}

TEST_CASE("twin_gaussian_process: fewer frames than neighbours, missing joints and misuse") {
  TwinGaussianProcesses baseline;
  CHECK_THROWS_AS(baseline.predict(random_clip(4, 3, 1)), ShapeError);
  CHECK_THROWS_AS(baseline.fit({}, {}), ShapeError);
  baseline.fit({random_clip(1, 3, 1), random_clip(6, 3, 2)},
               {random_clip(1, 2, 3), random_clip(6, 2, 4)});
  CHECK_THROWS_AS(baseline.predict(random_clip(4, 2, 1)), ShapeError);
  MatrixF gappy = random_clip(7, 3, 5), zeroed = gappy;
  gappy(2, 1) = NAN;
  zeroed(2, 1) = 0;
  CHECK(baseline.predict(gappy).allFinite());
  CHECK(baseline.predict(gappy) == baseline.predict(zeroed));
  CHECK(baseline.predict(MatrixF(0, 3)).rows() == 0);
  // Clips that stand still, all alike.
  baseline.fit({MatrixF::Ones(5, 3)}, {MatrixF::Constant(5, 2, 4)});
  CHECK((baseline.predict(MatrixF::Ones(2, 3)).array() - 4).abs().maxCoeff() < 1e-3F);
  TwinGaussianProcessSettings bad;
  bad.pose_noise = 0;
  CHECK_THROWS_AS(TwinGaussianProcesses{bad}, ConfigError);
}

}  // namespace twin_gaussian_processes_test
