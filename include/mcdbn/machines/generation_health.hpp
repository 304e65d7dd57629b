#pragma once

#include <cstddef>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Whether what was generated is bounded and alive.
struct GenerationHealth {
  /// [1 x visible] of each channel over all frames of all sequences: where data is standardized,
  /// the share of the training data's deviation.
  RowVectorD deviation;
  /// Of each sequence, RMS change of a channel from frame to frame over the last kLateFrames: next
  /// to nothing where it came to a stop.
  std::vector<double> late_speed;
  /// Of each sequence, mean_speed of what it went on from; empty where not given.
  std::vector<double> seed_speed = {};
  /// Of each sequence, the shortest lag in frames after which it comes back to where it was
  /// (shortest_cycle).
  std::vector<std::size_t> cycle;
  /// Of those that come back at all; 0 if none does.
  std::size_t shortest_of_cycles() const;

  static constexpr int kLateFrames = 200;
  /// How many sequences move at less than kSlow of their seed's speed in the end.
  std::size_t slow_sequences() const;
  static constexpr double kSlow = 0.5;
};

/// @param sequences standardized, [frames x visible] each
/// @param seed_speed mean_speed of what each went on from; or empty
/// @throws ShapeError if there are not as many of both
GenerationHealth generation_health(const std::vector<MatrixF>& sequences,
                                   const std::vector<double>& seed_speed = {});

/// RMS change of a channel from frame to frame.
double mean_speed(const MatrixF& sequence);

/// The first lag from 2 frames on at which the mean squared change has a minimum that is below
/// kComesBack of what it was at the largest on the way there: e.g. the stride of a walk; at least
/// two cycles must be in the sequence. 0 if there is none up to half of the sequence, the lag after
/// it being at most kLongestLag, as for what wanders or only shakes.
std::size_t shortest_cycle(const MatrixF& sequence);
inline constexpr double kComesBack = 0.7;
inline constexpr std::size_t kLongestLag = 90;  ///< frames

}  // namespace mcdbn
