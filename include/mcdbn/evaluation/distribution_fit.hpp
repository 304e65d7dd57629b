#pragma once

#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// The families that the paper's histograms of PCC are fitted with. Parameters, in this order:
/// normal: mean, standard deviation; log_normal: the same of the logarithm; gamma, weibull: shape,
/// scale; generalized_extreme_value: shape (negative: bounded above, the Weibull side), scale,
/// location.
enum class DistributionFamily { normal, log_normal, gamma, weibull, generalized_extreme_value };

/// The family's name in reports: normal, log-normal, gamma, Weibull, GEV.
std::string family_name(DistributionFamily family);

struct FittedParameter {
  std::string name;
  double value = 0;
  /// From the observed information; NaN where maximum likelihood is not regular (GEV of shape
  /// −0.5 or below, whose estimates have no normal limit, or of shape 1, where the search ends).
  double standard_error = 0;
};

/// A maximum-likelihood fit.
struct DistributionFit {
  DistributionFamily family = DistributionFamily::normal;
  std::vector<FittedParameter> parameters;
  double log_likelihood = 0;
  int samples = 0;

  double aic() const;
  double bic() const;
  /// Probability density at x, 0 outside of the support.
  double density(double x) const;
};

/// A GEV has a shape from −1 to 1: outside of these its likelihood has no bound.
/// @param samples two different values at least (GEV: four, and more than half of the samples above
///        the smallest), all finite; positive ones for log_normal, gamma and weibull
/// @throws InputError if the samples are not such
DistributionFit fit_distribution(DistributionFamily family,
                                 const Eigen::Ref<const Eigen::VectorXd>& samples);

/// Every family that fit_distribution takes the samples for, the smallest AIC first. Empty if they
/// are too few or all equal.
std::vector<DistributionFit> rank_distributions(const Eigen::Ref<const Eigen::VectorXd>& samples);

struct Interval {
  double low = 0, high = 0;
};

/// 95 % confidence interval of a positive parameter (Weibull's shape and scale): normal in its
/// logarithm, so that it stays positive.
Interval confidence_95(const FittedParameter& parameter);

/// A Weibull distribution (eq 52), shape k and scale l.
struct Weibull {
  double shape = 1, scale = 1;
};

/// Shape and scale of a fit of that family.
Weibull weibull_of(const DistributionFit& fit);

/// KL(f1 ‖ f2) in nats: eq 53, with Γ(k2/k1 + 1) where the paper prints −1. Its tables call the
/// scale k and the shape l.
double weibull_kl(const Weibull& f1, const Weibull& f2);

}  // namespace mcdbn
