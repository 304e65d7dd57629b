#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Generalized extreme value distribution; Boost.Math does not have it.
struct GeneralizedExtremeValue {
  double shape = 0, scale = 1, location = 0;

  /// −infinity outside of the support.
  double log_density(double x) const;
  /// Sum over samples.
  double log_likelihood(const Eigen::Ref<const Eigen::VectorXd>& samples) const;
};

struct GeneralizedExtremeValueFit {
  GeneralizedExtremeValue distribution;
  Eigen::Vector3d standard_errors;  ///< shape, scale, location; NaN where not regular
};

/// Maximum likelihood over shapes from −1 to 1. Below −1 the likelihood has no bound: the density
/// is infinite where the support ends. Nor has it one for large shapes: with the location at the
/// smallest sample, of which there are m among n, it grows like scale^(−m + (n − m) / shape) as the
/// scale shrinks, so without bound for shapes above (n − m) / m.
/// @param samples 2·m < n; then the likelihood has a bound
GeneralizedExtremeValueFit fit_generalized_extreme_value(
    const Eigen::Ref<const Eigen::VectorXd>& samples);

}  // namespace mcdbn
