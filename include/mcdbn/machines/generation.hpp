#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {

struct GenerationOptions {
  std::size_t frames = 300;  ///< of each sample, after the seed
  std::size_t samples = 1;   ///< of each seed
  /// Hidden units of the top layer are mean + temperature · (draw − mean): 1 draws them as the
  /// model has it, 0 draws nothing.
  double temperature = 1.0;
  std::size_t gibbs_steps = 30;  ///< drawn ones a frame, before the last, of means
  std::uint64_t seed = 1;
};

/// Algorithm 4, Taylor's: a CDBN of any depth runs on its own output. The seed goes up through the
/// layers (mean field). For each new frame the top CRBM starts from the frame before and alternates
/// Gibbs steps between its hidden units, which are drawn, and its visible ones, which are means,
/// under its own history; a last step is of means on both sides, for draws would shake the motion.
/// Then the layers below go down by mean field under theirs. What was generated is history at once.
/// All seeds and samples run as one batch: the top layer is one launch for all frames, where its
/// state fits the device's local memory.
/// @param seeds standardized, [frames x visible] each, at least seed_frames() of them; the last
///        count
/// @return the new frames alone, result[seed · samples + sample], [options.frames x visible]
/// @throws ShapeError
std::vector<MatrixF> generate(const Cdbn& cdbn, const std::vector<MatrixF>& seeds,
                              const GenerationOptions& options = {});

/// A free sample of a whole MCDBN: the modality `leads` runs freely from its seeds (Algorithm 4),
/// each other one is regenerated from it and those before (Algorithms 3 and 5).
/// @param seeds of the modality that leads  @param others how the others are regenerated, one
///        sample of each
/// @return the new frames alone, result[modality][seed · samples + sample]  @throws ShapeError
std::vector<std::vector<MatrixF>> generate(const Mcdbn& network, std::size_t leads,
                                           const std::vector<MatrixF>& seeds,
                                           const GenerationOptions& options = {},
                                           RegenerationOptions others = {});

/// Frames of a seed that generate() looks at: the history of all layers, one above another.
std::size_t seed_frames(const Cdbn& cdbn);

}  // namespace mcdbn
