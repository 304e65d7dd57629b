#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/model/mcdbn.hpp"

namespace mcdbn {

struct RegenerationOptions {
  std::size_t samples = 1;
  /// 0: mean field throughout (the best single answer). Above: Algorithm 5's sampled Gibbs steps,
  /// each draw pulled towards its mean as mean + temperature · (draw − mean).
  double temperature = 0.0;
  /// k for inference. Table 2 has 3, but only the first step starts from the code: on held-out CMU
  /// walks the error of samples at temperature 0.5 is 53 mm with k = 1 and 130 mm with k = 2.
  std::size_t gibbs_steps = 1;
  /// k of the MRBM's own sampled chain above temperature 0, each sample's for itself: then samples
  /// differ in the 3D code that is inferred, too. 0: mean field, one code for all samples.
  std::size_t mrbm_gibbs_steps = 0;
  std::uint64_t seed = 1;
  /// Frames of the repeated first 2D frame before the clip, in which the 3D history settles from
  /// the training mean: no ground truth at the start.
  std::size_t run_in = 30;
};

/// Algorithms 3 and 5 with their errata (DESIGN section 2): up-pass of the 2D CDBN, mean field (or
/// a sampled chain) of the MRBM, down-pass of the 3D CDBN with the code clamped, each frame's
/// history being what was regenerated before. All tracks and samples run as one batch, without a
/// host round trip a frame.
/// @param tracks standardized 2D, [frames x dimension], at least one frame each; NaN is filled in
///        by the 2D CDBN itself (complete_track)
/// @return standardized 3D for every track and sample: result[track · samples + sample],
///         [frames x dimension], as many frames as the track
/// @throws ShapeError
std::vector<MatrixF> regenerate(const Mcdbn& network, const std::vector<MatrixF>& tracks,
                                const RegenerationOptions& options = {});

}  // namespace mcdbn
