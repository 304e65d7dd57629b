#include "comparison/nearest_neighbour.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "clips.hpp"

namespace mcdbn {
namespace {

Eigen::Index naive_nearest(const MatrixF& training, const MatrixF& track, Eigen::Index frame) {
  Eigen::Index best = 0;
  double best_square = std::numeric_limits<double>::infinity();
  for (Eigen::Index row = 0; row < training.rows(); ++row) {
    double square = 0;
    for (Eigen::Index column = 0; column < training.cols(); ++column) {
      const double d = static_cast<double>(training(row, column)) - track(frame, column);
      square += d * d;
    }
    if (square < best_square) best_square = square, best = row;
  }
  return best;
}

}  // namespace

TEST_CASE("nearest_neighbour equals the naive search over block borders") {
  // 2048 training rows and 256 track rows make a block.
  const std::vector<MatrixF> tracks = {test::random_clip(2047, 17, 1),
                                       test::random_clip(2300, 17, 2)};
  const std::vector<MatrixF> poses = {test::random_clip(2047, 3, 3), test::random_clip(2300, 3, 4)};
  NearestNeighbour baseline;
  baseline.fit(tracks, poses);
  const MatrixF query = test::random_clip(300, 17, 5);
  MatrixF all_tracks(4347, 17), all_poses(4347, 3);
  all_tracks << tracks[0], tracks[1];
  all_poses << poses[0], poses[1];
  const auto rows = baseline.nearest_rows(query);
  const MatrixF pose = baseline.predict(query);
  for (Eigen::Index frame = 0; frame < query.rows(); ++frame) {
    const Eigen::Index expected = naive_nearest(all_tracks, query, frame);
    CHECK(rows[static_cast<std::size_t>(frame)] == expected);
    CHECK(pose.row(frame) == all_poses.row(expected));
  }
}

TEST_CASE("nearest_neighbour: the earliest of equal frames wins, far from the origin too") {
  // With a large common offset single-precision products do not distinguish frames.
  MatrixF training = test::random_clip(5000, 11, 6).array() + 300.0F;
  training.row(4999) = training.row(1234);
  training.row(3000) = training.row(1234);
  MatrixF numbers(5000, 1);
  for (int row = 0; row < 5000; ++row) numbers(row, 0) = static_cast<float>(row);
  NearestNeighbour baseline;
  baseline.fit({training}, {numbers});
  CHECK(baseline.predict(training.row(4999))(0, 0) == 1234.0F);
  const MatrixF query = test::random_clip(64, 11, 7).array() + 300.0F;
  for (Eigen::Index frame = 0; frame < query.rows(); ++frame)
    CHECK(baseline.nearest_rows(query)[static_cast<std::size_t>(frame)] ==
          naive_nearest(training, query, frame));
}

}  // namespace mcdbn
