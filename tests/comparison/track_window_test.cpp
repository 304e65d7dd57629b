#include "comparison/track_window.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "comparison/clips.hpp"
#include "mcdbn/base/errors.hpp"

namespace track_window_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("track_windows: five frames before, five after, ends repeated, unseen joints at 0") {
  MatrixF track(8, 2);
  for (Eigen::Index t = 0; t < 8; ++t) track.row(t) << static_cast<float>(t), 10.0F;
  track(6, 1) = NAN;
  const MatrixF windows = track_windows(track);
  REQUIRE(windows.rows() == 8);
  REQUIRE(windows.cols() == 22);
  for (Eigen::Index t = 0; t < 8; ++t)
    for (Eigen::Index k = 0; k < 11; ++k) {
      const Eigen::Index frame = std::min<Eigen::Index>(std::max<Eigen::Index>(t + k - 5, 0), 7);
      CHECK(windows(t, 2 * k) == static_cast<float>(frame));
      CHECK(windows(t, 2 * k + 1) == (frame == 6 ? 0.0F : 10.0F));
    }
  track(6, 1) = 3;
  CHECK(track_windows(track, 2, 3) == track_windows(track).middleRows(2, 3));
  CHECK(track_windows(MatrixF(0, 2)).rows() == 0);
}

TEST_CASE("window_pairs: all frames of all clips, windows within each") {
  const std::vector<MatrixF> tracks = {random_clip(4, 3, 1), MatrixF(0, 3), random_clip(7, 3, 2)};
  const std::vector<MatrixF> poses = {random_clip(4, 2, 3), MatrixF(0, 2), random_clip(7, 2, 4)};
  const WindowPairs pairs = window_pairs(tracks, poses);
  REQUIRE(pairs.windows.rows() == 11);
  CHECK(pairs.windows.topRows(4) == track_windows(tracks[0]));
  CHECK(pairs.windows.bottomRows(7) == track_windows(tracks[2]));
  CHECK(pairs.poses.bottomRows(7) == poses[2]);
  CHECK_THROWS_AS(window_pairs(tracks, {poses[0]}), ShapeError);
}

}  // namespace track_window_test
