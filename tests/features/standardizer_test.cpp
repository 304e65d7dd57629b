#include "mcdbn/features/standardizer.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

MatrixD example() {
  MatrixD values(4, 5);
  // A plain column, a constant that has no exact binary form, one with a gap, one all missing, one
  // that varies less than counts.
  values << 1, 0.1, 2, kUnknown, 5,          //
      3, 0.1, kUnknown, kUnknown, 5 + 1e-8,  //
      5, 0.1, 6, kUnknown, 5,                //
      7, 0.1, 4, kUnknown, 5 - 1e-8;
  return values;
}

}  // namespace

TEST_CASE("standardizer: mean and deviation over all blocks, NaN left out") {
  const MatrixD all = example(), top = all.topRows(1), bottom = all.bottomRows(3);
  const Standardizer scaling = Standardizer::fit({&top, &bottom});
  CHECK(scaling.input_dimension() == 5);
  CHECK(scaling.kept_columns() == std::vector<int>{0, 2});
  CHECK(scaling.mean()[0] == doctest::Approx(4));
  CHECK(scaling.deviation()[0] == doctest::Approx(std::sqrt(5.0)));
  CHECK(scaling.mean()[2] == doctest::Approx(4));
  CHECK(scaling.deviation()[2] == doctest::Approx(std::sqrt(8.0 / 3)));
}

TEST_CASE("standardizer: apply and invert; constant columns come back bit by bit") {
  const MatrixD all = example();
  const Standardizer scaling = Standardizer::fit({&all});
  const MatrixF standardized = scaling.apply(all);
  REQUIRE(standardized.cols() == 2);
  CHECK(std::isnan(standardized(1, 1)));
  CHECK(standardized.col(0).sum() == doctest::Approx(0));
  CHECK(standardized.col(0).squaredNorm() == doctest::Approx(4));
  const MatrixD back = scaling.invert(standardized);
  CHECK((back.col(0) - all.col(0)).norm() < 1e-6);
  CHECK(back.col(1) == all.col(1));
  CHECK(std::isnan(back(1, 2)));
  CHECK(back.col(3).isZero());
  CHECK((back.col(4) - all.col(4)).norm() < 1e-7);
}

TEST_CASE("standardizer: sizes are checked") {
  const MatrixD all = example(), narrow = all.leftCols(3);
  const Standardizer scaling = Standardizer::fit({&all});
  CHECK_THROWS_AS(Standardizer::fit({}), ShapeError);
  CHECK_THROWS_AS(Standardizer::fit({&all, &narrow}), ShapeError);
  CHECK_THROWS_AS(scaling.apply(narrow), ShapeError);
  CHECK_THROWS_AS(scaling.invert(MatrixF::Zero(2, 5)), ShapeError);
}

TEST_CASE("standardizer: JSON keeps every bit, and damage is noticed") {
  const MatrixD all = example();
  const Standardizer scaling = Standardizer::fit({&all});
  const nlohmann::json json = scaling.to_json();
  const Standardizer copy = Standardizer::from_json(nlohmann::json::parse(json.dump()), "scaling");
  CHECK(copy.mean() == scaling.mean());
  CHECK(copy.deviation() == scaling.deviation());
  CHECK(copy.kept_columns() == scaling.kept_columns());
  nlohmann::json damaged = json;
  damaged["kept"] = {0, 7};
  CHECK_THROWS_AS(Standardizer::from_json(damaged, "scaling"), InputError);
  damaged = json;
  damaged["mean"].erase(0);
  CHECK_THROWS_AS(Standardizer::from_json(damaged, "scaling"), InputError);
  damaged = json;
  damaged["deviation"] = "much";
  CHECK_THROWS_AS(Standardizer::from_json(damaged, "scaling"), InputError);
}
