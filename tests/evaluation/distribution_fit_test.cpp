#include "mcdbn/evaluation/distribution_fit.hpp"

#include <doctest/doctest.h>

#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/weibull.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using Family = DistributionFamily;

struct Known {
  Family family;
  std::vector<double> parameters;
  std::function<double(double)> quantile;
};

template <typename Distribution>
std::function<double(double)> quantile_of(Distribution distribution) {
  return [distribution](double p) { return boost::math::quantile(distribution, p); };
}

Known gev(double shape, double scale, double location) {
  return {Family::generalized_extreme_value, {shape, scale, location}, [=](double p) {
            return location + scale * std::expm1(-shape * std::log(-std::log(p))) / shape;
          }};
}

std::vector<Known> known_distributions() {
  using namespace boost::math;
  return {{Family::normal, {0.93, 0.02}, quantile_of(normal(0.93, 0.02))},
          {Family::normal, {-5, 3}, quantile_of(normal(-5, 3))},
          {Family::log_normal, {-0.1, 0.05}, quantile_of(lognormal(-0.1, 0.05))},
          {Family::log_normal, {1.5, 0.8}, quantile_of(lognormal(1.5, 0.8))},
          {Family::gamma, {0.6, 2}, quantile_of(gamma_distribution<>(0.6, 2))},
          {Family::gamma, {900, 0.001}, quantile_of(gamma_distribution<>(900, 0.001))},
          {Family::weibull, {12.637, 0.915}, quantile_of(weibull(12.637, 0.915))},
          {Family::weibull, {600, 0.99}, quantile_of(weibull(600, 0.99))},
          {Family::weibull, {0.8, 40}, quantile_of(weibull(0.8, 40))},
          gev(-0.3, 0.05, 0.88),
          gev(0.2, 2, -1),
          gev(1e-9, 1, 0)};
}

/// By the inverse distribution function: the same samples on every standard library.
Eigen::VectorXd draw(const Known& known, int count, unsigned seed) {
  std::mt19937_64 generator(seed);
  return Eigen::VectorXd::NullaryExpr(count, [&] {
    return known.quantile((static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53);
  });
}

double integral(const std::function<double(double)>& function, double low, double high) {
  boost::math::quadrature::tanh_sinh<double> rule;
  return rule.integrate(function, low, high);
}

}  // namespace

TEST_CASE("fits recover known parameters within 3 standard errors") {
  for (const Known& known : known_distributions())
    for (const unsigned seed : {1U, 2U, 3U}) {
      const DistributionFit fit = fit_distribution(known.family, draw(known, 2000, seed));
      REQUIRE(fit.parameters.size() == known.parameters.size());
      for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
        INFO(family_name(known.family), " ", fit.parameters[i].name, " ", seed);
        CHECK(std::abs(fit.parameters[i].value - known.parameters[i]) <=
              3 * fit.parameters[i].standard_error);
        CHECK(fit.parameters[i].standard_error <
              0.2 * std::max(1.0, std::abs(known.parameters[i])));
      }
    }
}

TEST_CASE("standard errors are the spread of the estimates over repetitions") {
  constexpr int kRepetitions = 200;
  for (const Known& known : known_distributions()) {
    Eigen::ArrayXd square = Eigen::ArrayXd::Zero(static_cast<int>(known.parameters.size()));
    for (int i = 0; i < kRepetitions; ++i) {
      const DistributionFit fit =
          fit_distribution(known.family, draw(known, 400, static_cast<unsigned>(1000 + i)));
      for (int p = 0; p < square.size(); ++p) {
        const auto& parameter = fit.parameters[static_cast<std::size_t>(p)];
        square(p) += std::pow((parameter.value - known.parameters[static_cast<std::size_t>(p)]) /
                                  parameter.standard_error,
                              2);
      }
    }
    // The root mean square of 200 standard normal values is 1 ± 0.05.
    CAPTURE(family_name(known.family));
    for (const double mean_square : square / kRepetitions) {
      CHECK(std::sqrt(mean_square) > 0.8);
      CHECK(std::sqrt(mean_square) < 1.2);
    }
  }
}

TEST_CASE("no neighbouring parameters are more likely, and the likelihood is that of the density") {
  for (const Known& known : known_distributions()) {
    INFO(family_name(known.family), " ", known.parameters[0]);
    const Eigen::VectorXd samples = draw(known, 300, 77);
    const DistributionFit fit = fit_distribution(known.family, samples);
    const auto log_likelihood = [&](const DistributionFit& candidate) {
      double sum = 0;
      for (const double x : samples) sum += std::log(candidate.density(x));
      return sum;
    };
    CHECK(log_likelihood(fit) == doctest::Approx(fit.log_likelihood).epsilon(1e-9));
    for (std::size_t i = 0; i < fit.parameters.size(); ++i)
      for (const double step : {-0.01, 0.01}) {
        DistributionFit moved = fit;
        moved.parameters[i].value += step * fit.parameters[i].standard_error;
        CHECK(log_likelihood(moved) < fit.log_likelihood);
      }
    CHECK(fit.aic() == doctest::Approx(2.0 * fit.parameters.size() - 2 * fit.log_likelihood));
    CHECK(fit.bic() ==
          doctest::Approx(fit.parameters.size() * std::log(300.0) - 2 * fit.log_likelihood));
  }
}

TEST_CASE("densities integrate to one") {
  for (const Known& known : known_distributions()) {
    if (known.family == Family::gamma && known.parameters[0] < 1) continue;  // a pole at zero
    const DistributionFit fit = fit_distribution(known.family, draw(known, 500, 5));
    INFO(family_name(known.family), " ", known.parameters[0]);
    const auto density = [&](double x) { return fit.density(x); };
    const double low = known.quantile(1e-7), middle = known.quantile(0.5),
                 high = known.quantile(1 - 1e-7);
    CHECK(integral(density, low, middle) + integral(density, middle, high) ==
          doctest::Approx(1).epsilon(0.01));
    CHECK(fit.density(known.family == Family::normal ? 1e6 : -1e6) == 0);
  }
}

TEST_CASE("the family that the samples come from ranks first") {
  for (const std::size_t i : {1U, 3U, 4U, 6U, 10U}) {
    const Known known = known_distributions()[i];
    const auto fits = rank_distributions(draw(known, 4000, 11));
    CAPTURE(family_name(known.family));
    CHECK(fits.front().family == known.family);
    for (std::size_t rank = 1; rank < fits.size(); ++rank)
      CHECK(fits[rank - 1].aic() <= fits[rank].aic());
  }
  // Samples below zero leave the families that cannot hold them out.
  CHECK(rank_distributions(draw(known_distributions()[1], 50, 1)).size() == 2);
  CHECK(rank_distributions(Eigen::VectorXd::Constant(50, 0.9)).empty());
}

TEST_CASE("GEV: a shape of −0.5 or below gets no standard errors, −1 is the end") {
  const DistributionFit fit =
      fit_distribution(Family::generalized_extreme_value, draw(gev(-0.7, 0.1, 0.9), 2000, 4));
  CHECK(fit.parameters[0].value == doctest::Approx(-0.7).epsilon(0.1));
  CHECK(std::isnan(fit.parameters[0].standard_error));
  const DistributionFit steep =
      fit_distribution(Family::generalized_extreme_value, draw(gev(-1.6, 0.1, 0.9), 2000, 4));
  CHECK(steep.parameters[0].value >= -1);
  CHECK(std::isfinite(steep.log_likelihood));
}

TEST_CASE("GEV: a fit to few samples keeps to shapes from −1 to 1, and has a finite scale") {
  const Known known = known_distributions()[0];
  int bounded = 0;
  for (const int count : {4, 5, 6})
    for (unsigned seed = 0; seed < 60; ++seed) {
      CAPTURE(count);
      CAPTURE(seed);
      const Eigen::VectorXd samples = draw(known, count, seed);
      const DistributionFit fit = fit_distribution(Family::generalized_extreme_value, samples);
      CHECK(std::abs(fit.parameters[0].value) <= 1);
      // The likelihood falls towards a scale of zero: its maximum is far from it.
      CHECK(fit.parameters[1].value > 1e-3 * (samples.maxCoeff() - samples.minCoeff()));
      CHECK(std::isfinite(fit.log_likelihood));
      if (fit.parameters[0].value < 0.9995) continue;
      ++bounded;
      CHECK(std::isnan(fit.parameters[0].standard_error));
    }
  CHECK(bounded > 0);
}

TEST_CASE("GEV: as many samples as parameters are too few, and so are many that are the smallest") {
  const auto refused = [](const std::vector<double>& values) {
    const Eigen::VectorXd samples =
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<int>(values.size()));
    CHECK_THROWS_AS(fit_distribution(Family::generalized_extreme_value, samples), InputError);
    const auto fits = rank_distributions(samples);
    CHECK(fits.size() == 4);
    for (const DistributionFit& fit : fits) CHECK(fit.family != Family::generalized_extreme_value);
    return fits.front();
  };
  refused({0.94, 0.95, 0.97});
  // By the formulas: a mean of 0.95733, a deviation of 0.0089567.
  const auto normal = fit_distribution(Family::normal, Eigen::Vector3d(0.951, 0.951, 0.97));
  CHECK(normal.aic() == doctest::Approx(-15.7785).epsilon(1e-5));
  CHECK(refused({0.951, 0.951, 0.97}).aic() > -16.5);
  refused({0.951, 0.951, 0.96, 0.97});
  refused({0.95, 0.95, 0.95, 0.96, 0.97, 0.97});
  // Equal but for rounding.
  refused({0.95, 0.95 + 1e-9, 0.95 - 1e-9, 0.96, 0.97, 0.98});
  refused({0.95, 0.95, 0.95, 0.96, 0.97, 0.98});  // four values, but half are the smallest
  // By a search over a grid of shapes, scales and locations: the largest shape is the likeliest.
  const DistributionFit tied =
      fit_distribution(Family::generalized_extreme_value,
                       (Eigen::VectorXd(5) << 0.951, 0.951, 0.96, 0.97, 0.98).finished());
  CHECK(tied.parameters[0].value == doctest::Approx(1).epsilon(1e-3));
  CHECK(tied.log_likelihood == doctest::Approx(16.3258).epsilon(1e-4));
}

TEST_CASE("GEV: many samples crowd the end of the support, standard errors remain") {
  // 300 times the samples of another fit: a seventeenth of its standard errors.
  const Known known = gev(-0.4, 0.1, 0.9);
  const DistributionFit few = fit_distribution(known.family, draw(known, 400, 8));
  const DistributionFit many = fit_distribution(known.family, draw(known, 120000, 9));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(many.parameters[i].value - known.parameters[i]) <=
          3 * many.parameters[i].standard_error);
    CHECK(many.parameters[i].standard_error * std::sqrt(300.0) ==
          doctest::Approx(few.parameters[i].standard_error).epsilon(0.3));
  }
}

TEST_CASE("fit_distribution names what it cannot use") {
  CHECK_THROWS_AS(fit_distribution(Family::gamma, Eigen::Vector3d(1, -1, 2)), InputError);
  CHECK_THROWS_AS(fit_distribution(Family::normal, Eigen::Vector3d(1, NAN, 2)), InputError);
  CHECK_THROWS_AS(fit_distribution(Family::weibull, Eigen::Vector3d(1, 1, 1)), InputError);
  CHECK_THROWS_AS(fit_distribution(Family::generalized_extreme_value, Eigen::Vector2d(1, 2)),
                  InputError);
  CHECK_THROWS_AS(weibull_of(fit_distribution(Family::normal, Eigen::Vector2d(1, 2))), ConfigError);
}

TEST_CASE("Weibull: 95 % confidence intervals hold the truth 95 times in 100") {
  const Known known = known_distributions()[6];
  int shape_held = 0, scale_held = 0;
  for (int i = 0; i < 400; ++i) {
    const DistributionFit fit =
        fit_distribution(Family::weibull, draw(known, 300, static_cast<unsigned>(5000 + i)));
    const Interval shape = confidence_95(fit.parameters[0]);
    const Interval scale = confidence_95(fit.parameters[1]);
    shape_held += shape.low <= 12.637 && 12.637 <= shape.high;
    scale_held += scale.low <= 0.915 && 0.915 <= scale.high;
  }
  // 380 ± 4.4: within 4 deviations.
  CHECK(shape_held > 362);
  CHECK(shape_held < 398);
  CHECK(scale_held > 362);
  CHECK(scale_held < 398);
}

TEST_CASE("weibull_kl: the paper's Table 7 from its printed parameters, columns swapped") {
  // The table's k is the scale and its l the shape (docs/paper.md, errata).
  CHECK(std::abs(weibull_kl({12.637, 0.9150}, {14.0953, 0.9456}) - 0.0843) < 5e-5);
  CHECK(std::abs(weibull_kl({10.8301, 0.8799}, {29.5768, 0.9760}) - 2.2619) < 5e-5);
  CHECK(std::abs(weibull_kl({4.6649, 0.7684}, {6.9702, 0.9073}) - 0.4576) < 5e-5);
}

TEST_CASE("weibull_kl equals the integral of f1 ln(f1 / f2)") {
  const std::vector<std::pair<Weibull, Weibull>> pairs = {
      {{12.637, 0.915}, {14.0953, 0.9456}}, {{2, 1}, {1.5, 3}}, {{3, 2}, {3, 2}}};
  for (const auto& [f1, f2] : pairs) {
    const boost::math::weibull first(f1.shape, f1.scale);
    const boost::math::weibull second(f2.shape, f2.scale);
    const auto integrand = [&](double x) {
      const double p = boost::math::pdf(first, x), q = boost::math::pdf(second, x);
      return p > 0 && q > 0 ? p * std::log(p / q) : 0.0;
    };
    const double expected = integral(integrand, 0, boost::math::quantile(first, 1 - 1e-15));
    CHECK(weibull_kl(f1, f2) == doctest::Approx(expected).epsilon(1e-7));
  }
}

}  // namespace mcdbn
