#include "comparison/ridge_window.hpp"

#include <doctest/doctest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "clips.hpp"

namespace mcdbn {
namespace {

/// Frame number at an offset, with the ends repeated.
int frame_at(int frame, int offset, int frames) {
  return std::min(std::max(frame + offset, 0), frames - 1);
}

/// A pose that a window regression can express: it looks three frames back and five ahead.
MatrixF lagged_pose(const MatrixF& track) {
  const int frames = static_cast<int>(track.rows());
  MatrixF pose(frames, 2);
  for (int t = 0; t < frames; ++t) {
    pose(t, 0) = 2 * track(frame_at(t, -3, frames), 0) - track(frame_at(t, 5, frames), 1) + 7;
    pose(t, 1) = 0.5F * track(t, 2) - 4;
  }
  return pose;
}

/// The same regression as an ordinary least-squares problem with √(penalty·n)·I stacked below,
/// solved by QR.
MatrixD stacked_least_squares(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses,
                              double penalty) {
  const int d2 = static_cast<int>(tracks[0].cols()), inputs = 11 * d2;
  int frames = 0;
  for (const MatrixF& track : tracks) frames += static_cast<int>(track.rows());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(frames + inputs, inputs + 1);
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(frames + inputs, poses[0].cols());
  int row = 0;
  for (std::size_t clip = 0; clip < tracks.size(); ++clip)
    for (int t = 0; t < tracks[clip].rows(); ++t, ++row) {
      for (int k = 0; k < 11; ++k)
        for (int j = 0; j < d2; ++j)
          x(row, k * d2 + j) =
              tracks[clip](frame_at(t, k - 5, static_cast<int>(tracks[clip].rows())), j);
      x(row, inputs) = 1;
      y.row(row) = poses[clip].row(t).cast<double>();
    }
  for (int i = 0; i < inputs; ++i) x(frames + i, i) = std::sqrt(penalty * frames);
  return x.colPivHouseholderQr().solve(y);
}

}  // namespace

TEST_CASE("ridge_window finds a lagged linear relation and carries it to another clip") {
  std::vector<MatrixF> tracks, poses;
  for (unsigned clip = 0; clip < 7; ++clip) {
    tracks.push_back(test::random_clip(60 + static_cast<int>(clip), 3, clip));
    poses.push_back(lagged_pose(tracks.back()));
  }
  RidgeWindow baseline;
  baseline.fit(tracks, poses);
  CHECK(baseline.penalty() == 1e-5);
  const MatrixF track = test::random_clip(40, 3, 99);
  CHECK((baseline.predict(track) - lagged_pose(track)).cwiseAbs().maxCoeff() < 2e-3F);
  // A constant track shows the bias alone, unpenalised.
  CHECK(baseline.predict(MatrixF::Zero(3, 3))(1, 0) == doctest::Approx(7).epsilon(1e-3));
}

TEST_CASE("ridge_window equals stacked least squares by QR at the penalty that it chose") {
  for (const std::size_t clips : {1U, 3U, 6U}) {
    std::vector<MatrixF> tracks, poses;
    for (std::size_t clip = 0; clip < clips; ++clip) {
      const auto seed = static_cast<unsigned>(10 * clips + clip);
      tracks.push_back(test::random_clip(50, 2, seed));
      poses.push_back(lagged_pose(test::random_clip(50, 3, seed)) +
                      3 * test::random_clip(50, 2, seed + 1000));
    }
    RidgeWindow baseline;
    baseline.fit(tracks, poses);
    const MatrixD expected = stacked_least_squares(tracks, poses, baseline.penalty());
    REQUIRE(baseline.coefficients().rows() == 23);
    CHECK((baseline.coefficients() - expected).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("ridge_window shrinks hard where tracks carry no information about poses") {
  std::vector<MatrixF> tracks, poses;
  for (unsigned clip = 0; clip < 10; ++clip) {
    tracks.push_back(test::random_clip(30, 4, 200 + clip));
    poses.push_back(test::random_clip(30, 3, 300 + clip));
  }
  RidgeWindow baseline;
  baseline.fit(tracks, poses);
  CHECK(baseline.penalty() >= 1.0);
}

TEST_CASE("ridge_window works over blocks of 2048 rows and on clips shorter than the window") {
  const MatrixF track = test::random_clip(5000, 3, 400);
  RidgeWindow baseline;
  baseline.fit({track, MatrixF::Zero(2, 3)},
               {lagged_pose(track), lagged_pose(MatrixF::Zero(2, 3))});
  CHECK((baseline.predict(track) - lagged_pose(track)).cwiseAbs().maxCoeff() < 1e-3F);
  CHECK((baseline.predict(MatrixF::Zero(1, 3)) - lagged_pose(MatrixF::Zero(1, 3)))
            .cwiseAbs()
            .maxCoeff() < 1e-3F);
}

}  // namespace mcdbn
