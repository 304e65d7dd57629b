#include "mcdbn/evaluation/distribution_fit.hpp"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/weibull.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "evaluation/generalized_extreme_value.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using boost::math::double_constants::euler;
using boost::math::double_constants::root_two_pi;
using Family = DistributionFamily;
using Samples = Eigen::Ref<const Eigen::VectorXd>;

/// Samples whose range is below this part of their magnitude are all equal for our purposes.
constexpr double kEqual = 1e-6;

bool needs_positive(Family family) {
  return family == Family::log_normal || family == Family::gamma || family == Family::weibull;
}

/// Why a GEV cannot be fitted to samples that are not all equal; empty if it can.
std::string obstacle_of_gev(const Samples& samples) {
  constexpr Eigen::Index kNeeded = 4;  // more than it has parameters
  const double equal = kEqual * samples.cwiseAbs().maxCoeff();
  Eigen::ArrayXd sorted = samples.array();
  std::sort(sorted.begin(), sorted.end());
  const Eigen::Index gaps = sorted.size() - 1;
  const Eigen::Index different = 1 + (sorted.tail(gaps) - sorted.head(gaps) > equal).count();
  if (different < kNeeded) return fmt::format("needs {} different samples or more", kNeeded);
  const Eigen::Index smallest = (sorted - sorted(0) <= equal).count();
  if (2 * smallest >= samples.size())  // its likelihood would have no maximum
    return "needs more than half of the samples above the smallest";
  return {};
}

/// Why the family cannot be fitted; empty if it can.
std::string obstacle(Family family, const Samples& samples) {
  if (samples.size() < 2) return "needs 2 samples or more";
  if (!samples.allFinite()) return "has samples that are not finite; leave them out";
  if (samples.maxCoeff() - samples.minCoeff() <= kEqual * samples.cwiseAbs().maxCoeff())
    return "has samples that are all equal";
  if (needs_positive(family) && !(samples.minCoeff() > 0)) return "needs positive samples";
  if (family == Family::generalized_extreme_value) return obstacle_of_gev(samples);
  return {};
}

/// Root of a monotone function of a positive variable, from a guess.
template <typename Function>
double positive_root(Function function, double guess, bool rising) {
  std::uintmax_t iterations = 200;
  const auto bracket = boost::math::tools::bracket_and_solve_root(
      function, guess, 2.0, rising, boost::math::tools::eps_tolerance<double>(50), iterations);
  return 0.5 * (bracket.first + bracket.second);
}

/// Two parameters with standard errors from their observed information matrix.
std::vector<FittedParameter> with_errors(const std::string& first_name, double first,
                                         const std::string& second_name, double second,
                                         const Eigen::Matrix2d& information) {
  const Eigen::Vector2d errors = information.inverse().diagonal().cwiseSqrt();
  return {{first_name, first, errors(0)}, {second_name, second, errors(1)}};
}

std::vector<FittedParameter> fit_normal(const Samples& x, const char* mean_name,
                                        const char* deviation_name) {
  const auto n = static_cast<double>(x.size());
  const double mean = x.mean();
  const double deviation = std::sqrt((x.array() - mean).square().mean());
  return {{mean_name, mean, deviation / std::sqrt(n)},
          {deviation_name, deviation, deviation / std::sqrt(2 * n)}};
}

std::vector<FittedParameter> fit_gamma(const Samples& x) {
  const auto n = static_cast<double>(x.size());
  const double mean = x.mean();
  const double s = -(x.array() / mean).log().mean();
  const double guess = (3 - s + std::sqrt((s - 3) * (s - 3) + 24 * s)) / (12 * s);
  const double shape = positive_root(
      [s](double k) { return std::log(k) - boost::math::digamma(k) - s; }, guess, false);
  const double scale = mean / shape;
  Eigen::Matrix2d information;
  information << boost::math::trigamma(shape), 1 / scale,  //
      1 / scale, shape / (scale * scale);
  return with_errors("shape", shape, "scale", scale, n * information);
}

std::vector<FittedParameter> fit_weibull(const Samples& x) {
  const auto n = static_cast<double>(x.size());
  // Powers of x over the largest sample: shapes of many hundreds do not overflow.
  const double largest = x.maxCoeff();
  const Eigen::ArrayXd u = (x.array() / largest).log();
  const double mean = u.mean();
  const double deviation = std::sqrt((u - mean).square().mean());
  const auto score = [&](double k) {
    const Eigen::ArrayXd power = (k * u).exp();
    return (power * u).sum() / power.sum() - 1 / k - mean;
  };
  const double guess = boost::math::double_constants::pi / (std::sqrt(6.0) * deviation);
  const double k = positive_root(score, guess, true);
  const double log_scale = std::log((k * u).exp().mean()) / k;
  const double scale = largest * std::exp(log_scale);

  const Eigen::ArrayXd log_ratio = u - log_scale;
  const Eigen::ArrayXd z = (k * log_ratio).exp();
  const double cross = -k / scale * (z * log_ratio).sum();
  Eigen::Matrix2d information;
  information << n / (k * k) + (z * log_ratio.square()).sum(), cross,  //
      cross, n * k * k / (scale * scale);
  return with_errors("shape", k, "scale", scale, information);
}

std::vector<FittedParameter> fit_gev(const Samples& x) {
  const auto [gev, errors] = fit_generalized_extreme_value(x);
  return {{"shape", gev.shape, errors(0)},
          {"scale", gev.scale, errors(1)},
          {"location", gev.location, errors(2)}};
}

std::vector<FittedParameter> fit_parameters(Family family, const Samples& samples) {
  switch (family) {
    case Family::normal:
      return fit_normal(samples, "mean", "sd");
    case Family::log_normal:
      return fit_normal(samples.array().log().matrix(), "log_mean", "log_sd");
    case Family::gamma:
      return fit_gamma(samples);
    case Family::weibull:
      return fit_weibull(samples);
    case Family::generalized_extreme_value:
      return fit_gev(samples);
  }
  throw ConfigError("unknown distribution family");
}

GeneralizedExtremeValue gev_of(const DistributionFit& fit) {
  return {fit.parameters[0].value, fit.parameters[1].value, fit.parameters[2].value};
}

/// Sums of logarithms, not logarithms of densities: those underflow for an outlier.
double log_likelihood_of(const DistributionFit& fit, const Samples& samples) {
  const Eigen::ArrayXd x = samples.array();
  const double a = fit.parameters[0].value, b = fit.parameters[1].value;
  const auto normal = [a, b](const Eigen::ArrayXd& values) {
    return (-0.5 * ((values - a) / b).square() - std::log(b * root_two_pi)).sum();
  };
  switch (fit.family) {
    case Family::normal:
      return normal(x);
    case Family::log_normal:
      return normal(x.log()) - x.log().sum();
    case Family::gamma:
      return ((a - 1) * x.log() - x / b - a * std::log(b) - boost::math::lgamma(a)).sum();
    case Family::weibull: {
      const Eigen::ArrayXd log_ratio = (x / b).log();
      return (std::log(a / b) + (a - 1) * log_ratio - (a * log_ratio).exp()).sum();
    }
    case Family::generalized_extreme_value:
      return gev_of(fit).log_likelihood(samples);
  }
  throw ConfigError("unknown distribution family");
}

}  // namespace

std::string family_name(DistributionFamily family) {
  switch (family) {
    case Family::normal:
      return "normal";
    case Family::log_normal:
      return "log-normal";
    case Family::gamma:
      return "gamma";
    case Family::weibull:
      return "Weibull";
    case Family::generalized_extreme_value:
      return "GEV";
  }
  throw ConfigError("unknown distribution family");
}

double DistributionFit::aic() const {
  return 2.0 * static_cast<double>(parameters.size()) - 2.0 * log_likelihood;
}

double DistributionFit::bic() const {
  return static_cast<double>(parameters.size()) * std::log(samples) - 2.0 * log_likelihood;
}

double DistributionFit::density(double x) const {
  if (needs_positive(family) && x <= 0) return 0;
  const double a = parameters[0].value, b = parameters[1].value;
  switch (family) {
    case Family::normal:
      return boost::math::pdf(boost::math::normal(a, b), x);
    case Family::log_normal:
      return boost::math::pdf(boost::math::lognormal(a, b), x);
    case Family::gamma:
      return boost::math::pdf(boost::math::gamma_distribution<>(a, b), x);
    case Family::weibull:
      return boost::math::pdf(boost::math::weibull(a, b), x);
    case Family::generalized_extreme_value:
      return std::exp(gev_of(*this).log_density(x));
  }
  throw ConfigError("unknown distribution family");
}

DistributionFit fit_distribution(DistributionFamily family,
                                 const Eigen::Ref<const Eigen::VectorXd>& samples) {
  const std::string reason = obstacle(family, samples);
  if (!reason.empty())
    throw InputError(fmt::format("the fit of a {} distribution {}", family_name(family), reason));
  DistributionFit fit{family, fit_parameters(family, samples), 0, static_cast<int>(samples.size())};
  fit.log_likelihood = log_likelihood_of(fit, samples);
  return fit;
}

std::vector<DistributionFit> rank_distributions(const Eigen::Ref<const Eigen::VectorXd>& samples) {
  std::vector<DistributionFit> fits;
  for (const Family family : {Family::normal, Family::log_normal, Family::gamma, Family::weibull,
                              Family::generalized_extreme_value})
    if (obstacle(family, samples).empty()) fits.push_back(fit_distribution(family, samples));
  std::stable_sort(
      fits.begin(), fits.end(),
      [](const DistributionFit& a, const DistributionFit& b) { return a.aic() < b.aic(); });
  return fits;
}

Interval confidence_95(const FittedParameter& parameter) {
  const double reach = boost::math::quantile(boost::math::normal(), 0.975) *
                       parameter.standard_error / parameter.value;
  return {parameter.value * std::exp(-reach), parameter.value * std::exp(reach)};
}

Weibull weibull_of(const DistributionFit& fit) {
  if (fit.family != Family::weibull) throw ConfigError("the fit is not one of a Weibull");
  return {fit.parameters[0].value, fit.parameters[1].value};
}

double weibull_kl(const Weibull& f1, const Weibull& f2) {
  const double k1 = f1.shape, l1 = f1.scale, k2 = f2.shape, l2 = f2.scale;
  // ln(k / l^k) is taken apart: l^k underflows for large shapes.
  const double log_normalisers = std::log(k1 / k2) - k1 * std::log(l1) + k2 * std::log(l2);
  return log_normalisers + (k1 - k2) * (std::log(l1) - euler / k1) +
         std::exp(k2 * std::log(l1 / l2) + boost::math::lgamma(k2 / k1 + 1)) - 1;
}

}  // namespace mcdbn
