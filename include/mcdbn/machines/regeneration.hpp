#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

struct RegenerationOptions {
  std::size_t samples = 1;
  /// 0: mean field throughout (the best single answer). Above: draws as `sampling` says, each
  /// pulled towards its mean as mean + temperature · (draw − mean).
  double temperature = 0.0;
  SamplingRule sampling;  ///< Algorithm 5's; a network's own is Mcdbn::sampling
  std::uint64_t seed = 1;
  /// Frames of the repeated first 2D frame before the clip, in which the 3D history settles from
  /// the training mean: no ground truth at the start.
  std::size_t run_in = 30;

  /// What draws are multiplied by.
  double drawn_share() const { return temperature * sampling.scale; }
};

/// Algorithms 3 and 5 with their errata (docs/paper.md): up-pass of the 2D CDBN, mean field (or
/// a sampled chain) of the MRBM, down-pass of the 3D CDBN with the code clamped, each frame's
/// history being what was regenerated before. All tracks and samples run as one batch, without a
/// host round trip a frame.
/// @param tracks standardized 2D, [frames x dimension], at least one frame each; NaN is filled in
///        by the 2D CDBN itself (complete_track) or left at the mean: Mcdbn::fills_gaps
/// @return standardized 3D for every track and sample: result[track · samples + sample],
///         [frames x dimension], as many frames as the track
/// @throws ShapeError
std::vector<MatrixF> regenerate(const Mcdbn& network, const std::vector<MatrixF>& tracks,
                                const RegenerationOptions& options = {});

/// The mean-field answer to one track: regenerate at temperature 0.
MatrixF single_answer(const Mcdbn& network, const MatrixF& track);

}  // namespace mcdbn
