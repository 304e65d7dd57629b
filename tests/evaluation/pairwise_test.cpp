#include "evaluation/pairwise.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "clips.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/evaluation/pearson.hpp"

namespace mcdbn {

TEST_CASE("pairwise_pearson: the first frames of the longer clip, pairs in order") {
  const std::vector<MatrixD> clips = {test::random_clip(12, 4, 1, 1), test::random_clip(7, 4, 1, 2),
                                      test::random_clip(9, 4, 1, 3)};
  const auto correlations = pairwise_pearson(clips);
  REQUIRE(correlations.size() == 3);
  CHECK(correlations[0] == doctest::Approx(pearson_flat(clips[0].topRows(7), clips[1])));
  CHECK(correlations[1] == doctest::Approx(pearson_flat(clips[0].topRows(9), clips[2])));
  CHECK(correlations[2] == doctest::Approx(pearson_flat(clips[1], clips[2].topRows(7))));
  CHECK(correlations[0] != correlations[1]);
}

TEST_CASE("pairwise_pearson: equal clips, few clips, clips that do not fit") {
  const MatrixD clip = test::random_clip(5, 2, 1, 4);
  CHECK(pairwise_pearson({clip, clip.topRows(3)}).at(0) == doctest::Approx(1));
  CHECK(std::isnan(pairwise_pearson({clip, MatrixD::Ones(5, 2)}).at(0)));
  CHECK(pairwise_pearson({clip}).empty());
  CHECK(pairwise_pearson({}).empty());
  CHECK_THROWS_AS(pairwise_pearson({clip, clip.leftCols(1)}), ShapeError);
  CHECK_THROWS_AS(pairwise_pearson({clip, MatrixD(0, 2)}), ShapeError);
}

}  // namespace mcdbn
