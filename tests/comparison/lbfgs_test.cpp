#include "comparison/lbfgs.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mcdbn;
using Eigen::VectorXd;

namespace {

/// Its only minimum is at (1, 1), along a bent valley.
double rosenbrock(const VectorXd& x, VectorXd& gradient) {
  const double along = 1 - x(0), across = x(1) - x(0) * x(0);
  gradient = Eigen::Vector2d(-2 * along - 400 * across * x(0), 200 * across);
  return along * along + 100 * across * across;
}

}  // namespace

TEST_CASE("minimize_lbfgs finds the end of Rosenbrock's valley") {
  const VectorXd found = minimize_lbfgs(rosenbrock, Eigen::Vector2d(-1.2, 1));
  CHECK((found - Eigen::Vector2d(1, 1)).norm() < 1e-5);
}

TEST_CASE("minimize_lbfgs solves an ill-conditioned quadratic in far fewer steps than descent") {
  const Eigen::Index n = 30;
  VectorXd scale(n), center(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    scale(i) = std::pow(10.0, 3.0 * static_cast<double>(i) / static_cast<double>(n - 1));
    center(i) = std::sin(static_cast<double>(i));
  }
  int calls = 0;
  const auto quadratic = [&](const VectorXd& x, VectorXd& gradient) {
    ++calls;
    gradient = scale.cwiseProduct(x - center);
    return 0.5 * gradient.dot(x - center);
  };
  LbfgsSettings settings;
  settings.steps = 200;
  const VectorXd found = minimize_lbfgs(quadratic, VectorXd::Zero(n), settings);
  CHECK((found - center).cwiseAbs().maxCoeff() < 1e-4);
  CHECK(calls < 300);  // with a condition of 1000 steepest descent takes thousands
}

TEST_CASE("minimize_lbfgs stops at a minimum, after its steps, and never goes uphill") {
  int calls = 0;
  const auto counted = [&](const VectorXd& x, VectorXd& gradient) {
    ++calls;
    return rosenbrock(x, gradient);
  };
  CHECK(minimize_lbfgs(counted, Eigen::Vector2d(1, 1)) == VectorXd(Eigen::Vector2d(1, 1)));
  CHECK(calls == 1);
  LbfgsSettings none;
  none.steps = 0;
  CHECK(minimize_lbfgs(rosenbrock, Eigen::Vector2d(3, 4), none) == VectorXd(Eigen::Vector2d(3, 4)));
  VectorXd gradient;
  double last = rosenbrock(Eigen::Vector2d(-1.2, 1), gradient);
  for (std::size_t steps = 1; steps < 30; ++steps) {
    LbfgsSettings few;
    few.steps = steps;
    const double value =
        rosenbrock(minimize_lbfgs(rosenbrock, Eigen::Vector2d(-1.2, 1), few), gradient);
    CHECK(value < last);
    last = value;
  }
}
