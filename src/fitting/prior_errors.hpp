#pragma once

#include <Eigen/Core>

#include "fitting/clip_posterior.hpp"
#include "fitting/slow_process.hpp"

namespace mcdbn {

/// Model of the errors of the prior's mean. Where rays are exact its values count for less
/// (`TrackFitSettings::exact_prior_weight`), its bends as elsewhere. Where their noise is steady a
/// turn's error depends less on its parent's (`exact_parent_correlation`); where it was measured
/// errors last longer (`measured_prior_error_time_s`). Keeps the clip.
class PriorErrors {
 public:
  PriorErrors(const PosteriorClip& clip, const RayNoise& noise, const TrackFitSettings& settings);

  /// How such an error runs over time, about what the parent predicts.
  const SlowProcess& process() const { return process_; }

  /// Expected turn per turn of the parent; 0 without a parent.
  double share_of_parent(Eigen::Index frame, int turn) const;

  /// Expected turn: with its parent, and for the rest with the world, where the camera leans
  /// otherwise than the one that the prior's mean was seen by. Radians, camera axes.
  /// @param parent its parent's turn; without a parent it does not count
  /// @param lean PosteriorPoint::lean
  Eigen::Vector3d expected_turn(Eigen::Index frame, int turn, const Eigen::Vector3d& parent,
                                const Eigen::Vector3d& lean) const;
  /// The part of expected_turn() that depends neither on the parent nor on the lean.
  Eigen::Vector3d expected_turn_at_rest(Eigen::Index frame, int turn) const;
  /// As expected_turn_at_rest(), of the turn's second difference about the frame.
  Eigen::Vector3d expected_bend_at_rest(Eigen::Index frame, int turn) const;

  /// Deviation of a turn from what its parent predicts, about each axis.
  double own_deviation_rad(Eigen::Index frame, int turn) const;

 private:
  int parent_of(int turn) const { return clip_.parents[static_cast<std::size_t>(turn)]; }

  const PosteriorClip& clip_;
  double parent_correlation_;
  SlowProcess process_;
};

}  // namespace mcdbn
