#pragma once

#include <Eigen/Core>
#include <functional>

namespace mcdbn::reference {

/// Gradient of `f` at `x` by central differences. With steps of 1e-5 in double precision its own
/// error is near 1e-10 for functions whose values and third derivatives are near 1.
inline Eigen::VectorXd finite_difference(const std::function<double(const Eigen::VectorXd&)>& f,
                                         const Eigen::VectorXd& x, double step = 1e-5) {
  Eigen::VectorXd gradient(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd moved = x;
    moved(i) = x(i) + step;
    const double above = f(moved);
    moved(i) = x(i) - step;
    gradient(i) = (above - f(moved)) / (2.0 * step);
  }
  return gradient;
}

}  // namespace mcdbn::reference
