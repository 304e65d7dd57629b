// The penalty of the ridge regression, found again by cross-validation written out.

#include <doctest/doctest.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "comparison/clips.hpp"
#include "comparison/ridge_window.hpp"

namespace ridge_penalty_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::array kPenalties{1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0};

/// Windows of frames from … to − 1 of a clip, with a last column of ones.
Eigen::MatrixXd windows(const MatrixF& track, Eigen::Index from, Eigen::Index to) {
  Eigen::MatrixXd rows(to - from, 11 * track.cols() + 1);
  for (Eigen::Index t = from; t < to; ++t)
    for (Eigen::Index k = 0; k < 11; ++k)
      rows.row(t - from).segment(k * track.cols(), track.cols()) =
          track.row(std::clamp<Eigen::Index>(t + k - 5, 0, track.rows() - 1)).cast<double>();
  rows.rightCols(1).setOnes();
  return rows;
}

struct Fold {
  Eigen::MatrixXd x, y;
  void add(const MatrixF& track, const MatrixF& pose, Eigen::Index from, Eigen::Index to) {
    const Eigen::MatrixXd more = windows(track, from, to);
    Eigen::MatrixXd all_x(x.rows() + more.rows(), more.cols()),
        all_y(x.rows() + more.rows(), pose.cols());
    all_x << x, more;
    all_y << y, pose.middleRows(from, to - from).cast<double>();
    x = all_x;
    y = all_y;
  }
};

double penalty_by_hand(const std::vector<Fold>& folds) {
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const double penalty : kPenalties) {
    double error = 0;
    for (std::size_t out = 0; out < folds.size(); ++out) {
      Fold rest{Eigen::MatrixXd(0, folds[0].x.cols()), Eigen::MatrixXd(0, folds[0].y.cols())};
      for (std::size_t i = 0; i < folds.size(); ++i) {
        if (i == out) continue;
        Eigen::MatrixXd x(rest.x.rows() + folds[i].x.rows(), rest.x.cols()),
            y(rest.y.rows() + folds[i].y.rows(), rest.y.cols());
        x << rest.x, folds[i].x;
        y << rest.y, folds[i].y;
        rest = {x, y};
      }
      const Eigen::Index inputs = rest.x.cols() - 1, frames = rest.x.rows();
      Eigen::MatrixXd x = Eigen::MatrixXd::Zero(frames + inputs, inputs + 1),
                      y = Eigen::MatrixXd::Zero(frames + inputs, rest.y.cols());
      x.topRows(frames) = rest.x;
      y.topRows(frames) = rest.y;
      x.bottomLeftCorner(inputs, inputs)
          .diagonal()
          .setConstant(std::sqrt(penalty * static_cast<double>(frames)));
      const Eigen::MatrixXd coefficients = x.colPivHouseholderQr().solve(y);
      error += (folds[out].x * coefficients - folds[out].y).squaredNorm();
    }
    if (error < least) least = error, best = penalty;
  }
  return best;
}

std::vector<Fold> empty_folds(Eigen::Index track, Eigen::Index pose) {
  return std::vector<Fold>(5, {Eigen::MatrixXd(0, 11 * track + 1), Eigen::MatrixXd(0, pose)});
}

/// Poses that follow their tracks by person: every two clips in a row are of one.
struct Clips {
  std::vector<MatrixF> tracks, poses;
  Clips(std::size_t count, float own, unsigned seed) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = seed + static_cast<unsigned>(i);
      tracks.push_back(random_clip(16 + 3 * static_cast<int>(i % 4), 2, number));
      const MatrixF person = random_clip(2, 3, seed + 500 + static_cast<unsigned>(i / 2));
      poses.push_back(tracks.back() * (MatrixF::Ones(2, 3) + own * person) +
                      0.5F * random_clip(static_cast<int>(tracks.back().rows()), 3, number + 900));
    }
  }
};

}  // namespace

TEST_CASE("ridge_window's penalty: whole clips that stand together are left out together") {
  std::vector<double> chosen;
  for (const float own : {0.0F, 1.0F, 4.0F})
    for (const std::size_t count : {5U, 7U, 12U}) {
      CAPTURE(own);
      CAPTURE(count);
      const Clips clips(count, own, 40 + static_cast<unsigned>(count));
      auto folds = empty_folds(2, 3);
      // Clip i of n is in fold ⌊5·i / n⌋.
      for (std::size_t i = 0; i < count; ++i)
        folds[5 * i / count].add(clips.tracks[i], clips.poses[i], 0, clips.tracks[i].rows());
      RidgeWindow baseline;
      baseline.fit(clips.tracks, clips.poses);
      CHECK(baseline.penalty() == penalty_by_hand(folds));
      chosen.push_back(baseline.penalty());
    }
  CHECK(*std::max_element(chosen.begin(), chosen.end()) >
        *std::min_element(chosen.begin(), chosen.end()));
}

TEST_CASE("ridge_window's penalty: fewer than five clips are cut into five pieces each") {
  for (const std::size_t count : {1U, 2U, 4U}) {
    CAPTURE(count);
    const Clips clips(count, 1.0F, 70 + static_cast<unsigned>(count));
    auto folds = empty_folds(2, 3);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Index frames = clips.tracks[i].rows();
      for (Eigen::Index piece = 0; piece < 5; ++piece)
        folds[static_cast<std::size_t>(piece)].add(clips.tracks[i], clips.poses[i],
                                                   piece * frames / 5, (piece + 1) * frames / 5);
    }
    RidgeWindow baseline;
    baseline.fit(clips.tracks, clips.poses);
    CHECK(baseline.penalty() == penalty_by_hand(folds));
  }
}

}  // namespace ridge_penalty_test
