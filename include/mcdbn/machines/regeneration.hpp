#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

struct RegenerationOptions {
  std::size_t samples = 1;
  /// 0: mean field throughout (the best single answer). Above: draws by `sampling`, each
  /// pulled towards its mean as mean + temperature · (draw − mean).
  double temperature = 0.0;
  SamplingRule sampling = {};  ///< Algorithm 5's; a network's own is Mcdbn::sampling
  std::uint64_t seed = 1;
  /// Frames of the repeated first frame before the clip, in which the wanted modality's history
  /// settles from the training mean: no ground truth at the start.
  std::size_t run_in = 30;

  /// Factor on draws' deviation from the mean.
  double drawn_share() const { return temperature * sampling.scale; }
  /// Whether the decoder's top layer is drawn; else mean field.
  bool samples_decoder() const { return drawn_share() > 0.0 && sampling.gibbs_steps > 0; }
  /// Whether each sample has an MRBM chain of its own; else one mean field for all.
  bool samples_mrbm() const { return drawn_share() > 0.0 && sampling.mrbm_gibbs_steps > 0; }
};

/// Algorithms 3 and 5 with their errata (docs/paper.md): up-pass of the present modalities' CDBNs,
/// mean field (or a sampled chain) of the MRBM, down-pass of the wanted one's CDBN with the code
/// clamped, each frame's history being what was regenerated before. All sequences and samples run
/// as one batch, without a host round trip a frame.
/// @param present of each modality standardized sequences [frames x dimension], at least one frame
///        each and the same frames in all; none for a modality that is absent. NaN is filled in
///        by the modality's CDBN itself (complete_sequence) or counts as 0: Mcdbn::fills_gaps
/// @param wanted the modality to regenerate, which is absent
/// @return standardized, for every sequence and sample: result[sequence · samples + sample],
///         [frames x dimension], as many frames as the sequence
/// @throws ShapeError
std::vector<MatrixF> regenerate(const Mcdbn& network,
                                const std::vector<std::vector<MatrixF>>& present,
                                std::size_t wanted, const RegenerationOptions& options = {});

/// The second modality from the first: 3D from 2D tracks.
std::vector<MatrixF> regenerate(const Mcdbn& network, const std::vector<MatrixF>& first,
                                const RegenerationOptions& options = {});

/// The mean-field answer to one sequence of the first modality: regenerate at temperature 0.
MatrixF single_answer(const Mcdbn& network, const MatrixF& first);

/// An answer and the code that it was decoded from.
struct CodedAnswer {
  MatrixF mean;  ///< [frames x dimension]
  MatrixF code;  ///< hidden units of the top layer [frames x code]
};

/// The second modality from the first with the codes: AnswerDeviation::of them is how far off
/// the answers may be. @return as regenerate does
std::vector<CodedAnswer> coded_answers(const Mcdbn& network, const std::vector<MatrixF>& first,
                                       const RegenerationOptions& options = {});

}  // namespace mcdbn
