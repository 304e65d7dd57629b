#include <doctest/doctest.h>

#include <cmath>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/random.hpp"
#include "mcdbn/machines/answer_deviation.hpp"

namespace answer_deviation_test {

using namespace mcdbn;

namespace {

constexpr Eigen::Index kFrames = 20000, kCode = 5, kVisible = 3;

float drawn(std::uint16_t phase, Eigen::Index row, Eigen::Index column) {
  return static_cast<float>(random_normal({7, 0, 0, phase}, static_cast<std::uint32_t>(row),
                                          static_cast<std::uint32_t>(column)));
}

/// Codes, the deviations that they stand for, and residuals drawn with those.
struct Problem {
  MatrixF code{kFrames, kCode}, deviations, residuals;
  AnswerDeviation truth{MatrixF(kCode, kVisible), MatrixF(1, kVisible)};

  Problem() {
    for (Eigen::Index i = 0; i < code.rows(); ++i)
      for (Eigen::Index j = 0; j < code.cols(); ++j)
        code(i, j) = 1 / (1 + std::exp(-drawn(1, i, j)));
    for (Eigen::Index i = 0; i < kCode; ++i)
      for (Eigen::Index j = 0; j < kVisible; ++j) truth.C(i, j) = 0.7F * drawn(2, i, j);
    truth.c << -1.0F, 0.0F, 2.0F;
    deviations = truth.of(code);
    residuals = deviations;
    for (Eigen::Index i = 0; i < code.rows(); ++i)
      for (Eigen::Index j = 0; j < kVisible; ++j) residuals(i, j) *= drawn(3, i, j);
  }
};

}  // namespace

TEST_CASE("answer deviation: the exponential of a linear function of the code") {
  AnswerDeviation deviation{MatrixF(2, 1), MatrixF(1, 1)};
  deviation.C << 1.0F, -2.0F;
  deviation.c << 0.5F;
  MatrixF code(1, 2);
  code << 0.25F, 0.5F;
  CHECK(deviation.of(code)(0, 0) == doctest::Approx(std::exp(0.5 + 0.25 - 1.0)));
  CHECK_THROWS_AS(deviation.of(MatrixF(1, 3)), ShapeError);
}

TEST_CASE("answer deviation: the deviations of drawn residuals are found again") {
  const Problem problem;
  const AnswerDeviation found = AnswerDeviation::fit(problem.code, problem.residuals);
  // ln|r| has the deviation pi/sqrt(8) = 1.1 about its mean: over 20,000 frames and 6 numbers a
  // column ln(sigma) is off by 1.1 * sqrt(6 / 20,000) = 0.02 on average.
  const double off =
      (found.of(problem.code).array() / problem.deviations.array()).log().square().mean();
  CHECK(std::sqrt(off) < 0.04);
  // In every column r/sigma is 1 on average, whatever the residuals' distribution.
  const MatrixF ratios = problem.residuals.array() / found.of(problem.code).array();
  for (Eigen::Index j = 0; j < kVisible; ++j)
    CHECK(ratios.col(j).array().square().mean() == doctest::Approx(1).epsilon(1e-3));
  CHECK_THROWS_AS(AnswerDeviation::fit(problem.code, MatrixF(3, kVisible)), ShapeError);
  CHECK_THROWS_AS(AnswerDeviation::fit(MatrixF(1, 2), MatrixF(1, 2)), ShapeError);
}

TEST_CASE("answer deviation: a column without any residual has a finite deviation above 0") {
  Problem problem;
  problem.residuals.col(1).setZero();
  const AnswerDeviation found = AnswerDeviation::fit(problem.code, problem.residuals);
  CHECK(found.c.allFinite());
  CHECK((found.of(problem.code).array() > 0).all());
}

TEST_CASE("answer deviation: calibrated on others it is as large as their residuals ask for") {
  const Problem problem;
  AnswerDeviation found = AnswerDeviation::fit(problem.code, problem.residuals);
  const MatrixF before = found.of(problem.code), theirs = 3.0F * problem.residuals;
  found.calibrate(theirs, before);
  const MatrixF ratios = theirs.array() / found.of(problem.code).array();
  CHECK(ratios.array().square().mean() == doctest::Approx(1).epsilon(1e-3));
  CHECK_THROWS_AS(found.calibrate(theirs, MatrixF(1, 1)), ShapeError);
}

}  // namespace answer_deviation_test
