#include "fitting/prior_deviations.hpp"

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"

namespace mcdbn {
namespace {

constexpr double kLeastTurn_rad = 0.1 * kRadiansPerDegree;
constexpr double kLeastAcceleration_m_s2 = 1e-3;

/// Variance of each feature before standardizing, summed over some of them.
/// @return [frames]
Eigen::VectorXd variance_of(const PosePrior& prior, const Standardizer& scale, int first,
                            int count) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(prior.deviation.rows());
  for (std::size_t k = 0; k < scale.kept_columns().size(); ++k) {
    const int column = scale.kept_columns()[k];
    if (column < first || column >= first + count) continue;
    sum += (scale.deviation()[column] *
            prior.deviation.col(static_cast<Eigen::Index>(k)).cast<double>())
               .cwiseAbs2();
  }
  return sum;
}

}  // namespace

MatrixD turn_deviations_rad(const PosePrior& prior, const Modalities& features,
                            const TrackFitSettings& settings) {
  const auto turns = static_cast<Eigen::Index>(features.pose_features.joints().size());
  MatrixD result = MatrixD::Constant(prior.mean.rows(), turns,
                                     settings.orientation_deviation_deg * kRadiansPerDegree);
  if (!prior.has_deviation()) return result;
  for (Eigen::Index turn = 0; turn < turns; ++turn)
    result.col(turn) =
        (variance_of(prior, features.pose_scale, PoseFeatures::kBlock * static_cast<int>(turn),
                     PoseFeatures::kBlock) /
         4)
            .cwiseSqrt()
            .cwiseMax(kLeastTurn_rad);
  return result;
}

MatrixD fitted_turn_deviations_rad(const PosePrior& prior, const Modalities& features,
                                   const TrackFitSettings& settings) {
  return turn_deviations_rad(prior, features, settings)
      .cwiseMax(settings.orientation_deviation_deg * kRadiansPerDegree);
}

double root_acceleration_deviation_m_s2(const PosePrior& prior, const Modalities& features,
                                        const TrackFitSettings& settings) {
  if (!prior.has_deviation() || prior.mean.rows() == 0) return settings.root_m_s2;
  const double variance =
      variance_of(prior, features.pose_scale, features.pose_features.velocity_feature(), 3).mean() /
      3;
  return std::max(kLeastAcceleration_m_s2, std::sqrt(variance) / settings.prior_error_time_s);
}

double fitted_root_acceleration_deviation_m_s2(const PosePrior& prior, const Modalities& features,
                                               const TrackFitSettings& settings) {
  return std::max(settings.root_m_s2, root_acceleration_deviation_m_s2(prior, features, settings));
}

}  // namespace mcdbn
