#include "evaluation/generalized_extreme_value.hpp"

#include <Eigen/Cholesky>
#include <boost/math/constants/constants.hpp>
#include <boost/math/differentiation/autodiff.hpp>
#include <cmath>
#include <limits>
#include <opencv2/core/optim.hpp>
#include <type_traits>

#include "base/numbers.hpp"

namespace mcdbn {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGumbelBelow = 1e-12;  ///< shapes that are zero for all purposes
constexpr double kSteepest = 1;         ///< largest shape of either sign that is searched

/// Shape, logarithm of the scale, location: free of constraints but for the shape.
GeneralizedExtremeValue from_search(const Eigen::Vector3d& at) {
  return {at(0), std::exp(at(1)), at(2)};
}

/// What the search makes smallest: −log likelihood, and where the distribution is not allowed a
/// number above all others, as OpenCV takes no infinity.
class Cost : public cv::MinProblemSolver::Function {
 public:
  explicit Cost(const Eigen::VectorXd& samples) : samples_(samples) {}

  int getDims() const override { return 3; }
  double calc(const double* at) const override {
    constexpr double kNotAllowed = 1e300;
    if (std::abs(at[0]) > kSteepest) return kNotAllowed;
    const double cost =
        -from_search(Eigen::Map<const Eigen::Vector3d>(at)).log_likelihood(samples_);
    return cost < kNotAllowed ? cost : kNotAllowed;
  }

 private:
  const Eigen::VectorXd& samples_;
};

/// By the simplex method of Nelder and Mead, which needs no derivatives. It may stop on a slope, so
/// it starts over from where it stopped until that gains nothing.
Eigen::Vector3d smallest(const cv::Ptr<Cost>& cost, Eigen::Vector3d at) {
  constexpr int kStarts = 10, kEvaluations = 4000;
  constexpr double kStep = 0.1, kSmallestGain = 1e-9;
  const auto solver = cv::DownhillSolver::create(
      cost, cv::Mat(1, 3, CV_64F, cv::Scalar(kStep)),
      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kEvaluations, kSmallestGain});
  double value = cost->calc(at.data());
  for (int start = 0; start < kStarts; ++start) {
    Eigen::Vector3d found = at;
    cv::Mat there(1, 3, CV_64F, found.data());
    const double found_value = solver->minimize(there);
    if (found_value < value) at = found;
    if (!(value - found_value > kSmallestGain)) break;
    value = found_value;
  }
  return at;
}

/// log(1 + shape·z) / shape, smooth with its derivatives through shape 0 (Gumbel).
template <typename Shape, typename Z>
auto reduced(const Shape& shape, const Z& z) {
  constexpr double kSeriesBelow = 1e-3;
  using std::log;
  const auto t = shape * z;
  using Result = std::decay_t<decltype(t)>;
  if (std::abs(static_cast<double>(t)) < kSeriesBelow)
    return Result(z * (1 - t * (1.0 / 2 - t * (1.0 / 3 - t * (1.0 / 4 - t / 5)))));
  return Result(log(1 + t) / shape);
}

/// Observed information of (shape, scale, location), by automatic differentiation: the support ends
/// so close to the largest of many samples that differences would step over its border.
Eigen::Matrix3d observed_information(const Eigen::VectorXd& samples,
                                     const GeneralizedExtremeValue& fit) {
  const auto variables = boost::math::differentiation::make_ftuple<double, 2, 2, 2>(
      fit.shape, fit.scale, fit.location);
  const auto& [shape, scale, location] = variables;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const double x : samples) {
    const auto y = reduced(shape, (x - location) / scale);
    const auto cost = (1 + shape) * y + exp(-y) + log(scale);
    information(0, 0) += cost.derivative(2, 0, 0);
    information(1, 1) += cost.derivative(0, 2, 0);
    information(2, 2) += cost.derivative(0, 0, 2);
    information(1, 0) += cost.derivative(1, 1, 0);
    information(2, 0) += cost.derivative(1, 0, 1);
    information(2, 1) += cost.derivative(0, 1, 1);
  }
  return information.selfadjointView<Eigen::Lower>();
}

Eigen::Vector3d standard_errors(const Eigen::VectorXd& samples,
                                const GeneralizedExtremeValue& fit) {
  constexpr double kOfTheBound = 1e-3;  // so near the search stops there
  if (fit.shape <= -0.5 || fit.shape >= kSteepest - kOfTheBound)
    return Eigen::Vector3d::Constant(kNan);
  const Eigen::Matrix3d information = observed_information(samples, fit);
  const Eigen::LLT<Eigen::Matrix3d> factor(information);
  if (!information.allFinite() || factor.info() != Eigen::Success)
    return Eigen::Vector3d::Constant(kNan);
  return factor.solve(Eigen::Matrix3d::Identity()).diagonal().cwiseSqrt();
}

}  // namespace

double GeneralizedExtremeValue::log_density(double x) const {
  return log_likelihood(Eigen::Matrix<double, 1, 1>(x));
}

double GeneralizedExtremeValue::log_likelihood(
    const Eigen::Ref<const Eigen::VectorXd>& samples) const {
  if (!(scale > 0)) return -kInfinity;
  const Eigen::ArrayXd z = (samples.array() - location) / scale;
  if (!((shape * z).minCoeff() > -1)) return -kInfinity;
  // log1p keeps the passage through shape 0 (Gumbel) smooth.
  const Eigen::ArrayXd y =
      std::abs(shape) < kGumbelBelow ? z : Eigen::ArrayXd((shape * z).log1p() / shape);
  return -((1 + shape) * y + (-y).exp()).sum() -
         static_cast<double>(samples.size()) * std::log(scale);
}

GeneralizedExtremeValueFit fit_generalized_extreme_value(
    const Eigen::Ref<const Eigen::VectorXd>& samples) {
  const double mean = samples.mean();
  const double deviation = std::sqrt((samples.array() - mean).square().mean());
  const Eigen::VectorXd standardized = (samples.array() - mean) / deviation;
  // The Gumbel distribution of the same mean and variance: no sample is outside of its support.
  using namespace boost::math::double_constants;
  const double gumbel_scale = std::sqrt(6.0) / pi;
  const Eigen::Vector3d start(0, std::log(gumbel_scale), -euler * gumbel_scale);
  GeneralizedExtremeValue fit = from_search(smallest(cv::makePtr<Cost>(standardized), start));

  Eigen::Vector3d errors = standard_errors(standardized, fit);
  errors.tail<2>() *= deviation;
  fit.scale *= deviation;
  fit.location = mean + deviation * fit.location;
  return {fit, errors};
}

}  // namespace mcdbn
