#include "comparison/baseline.hpp"

#include <doctest/doctest.h>

#include "clips.hpp"
#include "comparison/constant_pose.hpp"
#include "comparison/hold_last_frame.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

TEST_CASE("default_baselines: names, in the order of the reports") {
  const auto baselines = default_baselines();
  REQUIRE(baselines.size() == 4);
  CHECK(baselines[0]->name() == "mean_pose");
  CHECK(baselines[1]->name() == "hold_last_frame");
  CHECK(baselines[2]->name() == "nearest_neighbour");
  CHECK(baselines[3]->name() == "ridge_window");
}

TEST_CASE("every baseline: shapes, missing joints and misuse") {
  const std::vector<MatrixF> tracks = {test::random_clip(14, 3, 1), test::random_clip(9, 3, 2)};
  const std::vector<MatrixF> poses = {test::random_clip(14, 5, 3), test::random_clip(9, 5, 4)};
  for (const auto& baseline : default_baselines()) {
    CAPTURE(baseline->name());
    CHECK_THROWS_AS(baseline->predict(tracks[0]), ShapeError);
    CHECK_THROWS_AS(baseline->fit(tracks, {poses[0]}), ShapeError);
    CHECK_THROWS_AS(baseline->fit(tracks, {poses[1], poses[0]}), ShapeError);
    CHECK_THROWS_AS(baseline->fit({}, {}), ShapeError);
    baseline->fit(tracks, poses);
    CHECK_THROWS_AS(baseline->predict(test::random_clip(4, 2, 5)), ShapeError);

    MatrixF unseen = test::random_clip(21, 3, 6), zeroed = unseen;
    unseen(4, 1) = unseen(20, 2) = NAN;
    zeroed(4, 1) = zeroed(20, 2) = 0;
    const MatrixF pose = baseline->predict(unseen);
    CHECK(pose.rows() == 21);
    CHECK(pose.cols() == 5);
    CHECK(pose.allFinite());
    CHECK(pose == baseline->predict(zeroed));

    // The same in training.
    std::vector<MatrixF> gappy = tracks, filled = tracks;
    gappy[1](3, 0) = NAN;
    filled[1](3, 0) = 0;
    baseline->fit(gappy, poses);
    const MatrixF from_gappy = baseline->predict(zeroed);
    baseline->fit(filled, poses);
    CHECK(from_gappy == baseline->predict(zeroed));
    CHECK(baseline->predict(MatrixF(0, 3)).rows() == 0);
  }
}

TEST_CASE("mean_pose weighs frames, not clips") {
  ConstantPose baseline;
  baseline.fit({MatrixF::Zero(1, 2), MatrixF::Zero(3, 2)},
               {MatrixF::Constant(1, 1, 8), MatrixF::Constant(3, 1, 4)});
  CHECK(baseline.predict(MatrixF::Ones(2, 2)) == MatrixF::Constant(2, 1, 5));
}

TEST_CASE("hold_last_frame holds the nearest neighbour of the first frame") {
  const std::vector<MatrixF> tracks = {test::random_clip(14, 3, 1)};
  const std::vector<MatrixF> poses = {test::random_clip(14, 5, 3)};
  HoldLastFrame baseline;
  baseline.fit(tracks, poses);
  CHECK(baseline.predict(tracks[0].bottomRows(4)) == poses[0].row(10).replicate(4, 1));
}

}  // namespace mcdbn
