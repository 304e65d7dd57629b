#pragma once

#include <Eigen/Core>
#include <functional>

namespace mcdbn {

/// Minimises a function of three variables by the simplex method of Nelder and Mead (1965), which
/// needs no derivatives and takes +infinity for "not allowed". Starts over from where it converged
/// until that gains nothing.
Eigen::Vector3d nelder_mead(const std::function<double(const Eigen::Vector3d&)>& function,
                            const Eigen::Vector3d& start, double step);

}  // namespace mcdbn
