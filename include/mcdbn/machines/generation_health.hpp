#pragma once

#include <cstddef>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Whether generated sequences stay bounded and keep moving.
struct GenerationHealth {
  /// Standard deviation of each channel over all frames of all sequences [1 x visible]: where data
  /// is standardized, relative to the training data's.
  RowVectorD deviation;
  /// RMS change of a channel from frame to frame over the last kLateFrames, by sequence; near 0: it
  /// stopped.
  std::vector<double> late_speed;
  /// mean_speed() of the motion that each sequence continues; empty where not given.
  std::vector<double> seed_speed = {};
  /// shortest_cycle() of each sequence, in frames; 0: it does not repeat itself.
  std::vector<std::size_t> cycle;
  /// Shortest `cycle` above 0; 0 if no sequence repeats itself.
  std::size_t shortest_of_cycles() const;

  static constexpr int kLateFrames = 200;
  /// Number of sequences that move at less than kSlowShare of their seed's speed in the end.
  std::size_t slow_sequences() const;
  static constexpr double kSlowShare = 0.5;
};

/// @param sequences standardized, [frames x visible] each
/// @param seed_speed mean_speed of the motion that each continues; or empty
/// @throws ShapeError if there are not as many of both
GenerationHealth generation_health(const std::vector<MatrixF>& sequences,
                                   const std::vector<double>& seed_speed = {});

/// RMS change of a channel from frame to frame.
double mean_speed(const MatrixF& sequence);

/// The first lag from 2 frames on at which the mean squared change has a minimum that is below
/// kCycleDepth of what it was at the largest on the way there: e.g. the stride of a walk; at least
/// two cycles must be in the sequence. 0 if there is none up to half of the sequence, the lag after
/// it being at most kLongestLag, as for what wanders or only shakes.
std::size_t shortest_cycle(const MatrixF& sequence);
inline constexpr double kCycleDepth = 0.7;
inline constexpr std::size_t kLongestLag = 90;  ///< frames

}  // namespace mcdbn
