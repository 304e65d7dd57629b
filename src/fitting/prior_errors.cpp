#include "fitting/prior_errors.hpp"

#include <cmath>

namespace mcdbn {

PriorErrors::PriorErrors(const PosteriorClip& clip, const RayNoise& noise,
                         const TrackFitSettings& settings)
    : clip_(clip),
      parent_correlation_(noise.steady ? settings.exact_parent_correlation
                                       : settings.parent_correlation),
      process_(noise.measured ? settings.measured_prior_error_time_s : settings.prior_error_time_s,
               clip.frame_time_s) {
  if (noise.exact) process_.value_weight *= settings.exact_prior_weight;
}

double PriorErrors::share_of_parent(Eigen::Index frame, int turn) const {
  const int parent = parent_of(turn);
  return parent < 0 ? 0
                    : parent_correlation_ * clip_.turn_deviation_rad(frame, turn) /
                          clip_.turn_deviation_rad(frame, parent);
}

Eigen::Vector3d PriorErrors::expected_turn_at_rest(Eigen::Index frame, int turn) const {
  if (clip_.mean_lean.rows() == 0) return Eigen::Vector3d::Zero();
  return (share_of_parent(frame, turn) - 1) * clip_.mean_lean.row(frame).transpose();
}

Eigen::Vector3d PriorErrors::expected_bend_at_rest(Eigen::Index frame, int turn) const {
  if (clip_.mean_lean.rows() == 0) return Eigen::Vector3d::Zero();
  const auto lean = clip_.mean_lean.middleRows(frame - 1, 3);
  return (share_of_parent(frame, turn) - 1) *
         (lean.row(0) - 2 * lean.row(1) + lean.row(2)).transpose();
}

Eigen::Vector3d PriorErrors::expected_turn(Eigen::Index frame, int turn,
                                           const Eigen::Vector3d& parent,
                                           const Eigen::Vector3d& lean) const {
  const double share = share_of_parent(frame, turn);
  return share * parent + (1 - share) * lean + expected_turn_at_rest(frame, turn);
}

double PriorErrors::own_deviation_rad(Eigen::Index frame, int turn) const {
  const double own =
      parent_of(turn) < 0 ? 1 : std::sqrt(1 - parent_correlation_ * parent_correlation_);
  return own * clip_.turn_deviation_rad(frame, turn);
}

}  // namespace mcdbn
