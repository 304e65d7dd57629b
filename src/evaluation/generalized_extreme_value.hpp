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

/// Maximum likelihood over shapes of −1 and above: below, the likelihood has no bound.
GeneralizedExtremeValueFit fit_generalized_extreme_value(
    const Eigen::Ref<const Eigen::VectorXd>& samples);

}  // namespace mcdbn
