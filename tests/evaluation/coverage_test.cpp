#include "evaluation/coverage.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "base/random_sequence.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

TEST_CASE("coverage by hand: what lies within 1.645 deviations is held, by name and in all") {
  MatrixD truth(2, 4), mean = MatrixD::Zero(2, 4), deviation = MatrixD::Ones(2, 4);
  truth << 1.64, -1.65, 0, 3,  //
      -1.64, 1.66, 5, std::numeric_limits<double>::quiet_NaN();
  deviation(1, 2) = 4;
  Coverage coverage;
  CHECK(coverage.empty());
  coverage.add({"a", "b"}, truth, mean, deviation);
  CHECK(coverage.by_name().at("a").share() == 0.5);
  CHECK(coverage.by_name().at("b").share() == doctest::Approx(2.0 / 3));
  CHECK(coverage.by_name().at("b").mean_deviation() == doctest::Approx(2));
  CHECK(coverage.overall().share() == doctest::Approx(4.0 / 7));
  coverage.add({"c"}, MatrixD::Constant(1, 1, 7), MatrixD::Constant(1, 1, 6.5),
               MatrixD::Constant(1, 1, 0.5));
  CHECK(coverage.overall().share() == doctest::Approx(5.0 / 8));
  const auto json = coverage_json(coverage);
  CHECK(json["all"]["share"] == doctest::Approx(5.0 / 8));
  CHECK(json["by_name"]["c"]["mean_deviation"] == 0.5);
  CHECK_THROWS_AS(coverage.add({"a"}, truth, mean.leftCols(3), deviation), ShapeError);
  CHECK_THROWS_AS(coverage.add({"a", "b", "c"}, truth, mean, deviation), ShapeError);
}

TEST_CASE("nine tenths of normal draws are held by their own deviations, fewer by smaller ones") {
  RandomSequence random(4);
  constexpr int kDraws = 20000;
  MatrixD truth(kDraws, 1);
  for (double& value : truth.reshaped()) value = 3 * random.normal() + 1;
  const auto share = [&](double deviation) {
    Coverage coverage;
    coverage.add({"x"}, truth, MatrixD::Ones(kDraws, 1), MatrixD::Constant(kDraws, 1, deviation));
    return coverage.overall().share();
  };
  const double bound = 5 * std::sqrt(0.09 / kDraws);
  CHECK(std::abs(share(3) - 0.9) < bound);
  CHECK(share(2) < 0.8);
  CHECK(share(4) > 0.95);
}
