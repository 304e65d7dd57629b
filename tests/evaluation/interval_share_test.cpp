// How many intervals hold the truth.

#include "mcdbn/evaluation/interval_share.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "clips.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

TEST_CASE("90 % intervals: each number by its own deviation, both ends") {
  MatrixD truth(1, 4), answer(1, 4), deviation(1, 4);
  truth << 10, 10, 10, 10;
  answer << 10, 11.64, 8.35, 13.28;
  deviation << 0, 1, 1, 2;
  // The first is met, the second lies within 1.645, the third is off by 1.65, the fourth by 3.28.
  CHECK(share_within_90(truth, answer, deviation) == 0.75);
  deviation(0, 3) = 1.9;
  CHECK(share_within_90(truth, answer, deviation) == 0.5);
}

TEST_CASE("90 % intervals: of normal errors nine of ten, if the deviation is theirs") {
  const MatrixD truth = MatrixD::Zero(500, 40), answer = test::random_clip(500, 40, 3, 1);
  const auto share = [&](double deviation) {
    return share_within_90(truth, answer, MatrixD::Constant(500, 40, deviation));
  };
  // 20,000 of them: 0.9 to within five deviations of sqrt(0.9 · 0.1 / 20000).
  CHECK(std::abs(share(3) - 0.9) < 5 * std::sqrt(0.09 / 20000));
  CHECK(share(1.5) < 0.7);
  CHECK(share(6) > 0.99);
}

TEST_CASE("90 % intervals: shapes, and no answer at all") {
  CHECK(std::isnan(share_within_90(MatrixD(), MatrixD(), MatrixD())));
  CHECK_THROWS_AS(share_within_90(MatrixD::Zero(2, 3), MatrixD::Zero(2, 3), MatrixD::Zero(2, 2)),
                  ShapeError);
  CHECK_THROWS_AS(share_within_90(MatrixD::Zero(2, 3), MatrixD::Zero(1, 3), MatrixD::Zero(2, 3)),
                  ShapeError);
}
