#pragma once

#include <Eigen/Core>
#include <functional>

namespace mcdbn {

struct LbfgsSettings {
  std::size_t history = 8;  ///< steps that the inverse Hessian is built from
  std::size_t steps = 100;  ///< at most
  double tolerance = 1e-6;  ///< of the gradient's length, relative to max(1, length of x)
};

/// A function's value; its gradient at x goes to the second argument, which has x's size.
using DifferentiableFunction =
    std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;

/// A local minimum from `start` downhill by L-BFGS (Nocedal 1980) with a line search that halves
/// its step until the value falls enough (Armijo).
/// @return where the gradient vanishes, no step leads farther down, or the steps are used up
Eigen::VectorXd minimize_lbfgs(const DifferentiableFunction& function, Eigen::VectorXd start,
                               const LbfgsSettings& settings = {});

}  // namespace mcdbn
