#pragma once

#include <cstdint>

#include "mcdbn/machines/mcdbn.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// F(v | H) = −log Σ_h exp(−E(v, h | H)) of every frame that has a history: −log p(v | H) but for
/// the partition function, which depends on H (log_partition).
/// Gaussian units: ½ ‖v − â‖² − Σ_j log(1 + exp(b̂_j + v·W_j)), eq 9 and 14 with their erratum (plus
/// before the quadratic term), v being the frame over visible_deviation; binary ones: −v·â in place
/// of the square (eq 2).
/// @return [all frames x 1], rows numbered as the frames are  @throws ShapeError
Sequences free_energy(const Crbm& crbm, const Sequences& visible);

/// Free energy of the top machine on its code, the up-pass of the layers beneath: that of the whole
/// stack has no closed form.
Sequences free_energy(const Cdbn& cdbn, const Sequences& visible);

/// F(v¹, v² …) of an MRBM, its hidden units summed out (eq 19): −log p(v¹, v² …) but for the
/// partition function.
/// @param modalities [rows x visible] of each, not indexed  @return [rows x 1]  @throws ShapeError
Matrix free_energy(const Mrbm& mrbm, const std::vector<Rows>& modalities);

/// Free energy of the MRBM on the modalities' codes, in frames where every modality has one.
/// @param modalities the same clips in each  @return [all frames x 1], rows numbered as the frames
/// of the modalities without a look-ahead are; NaN where there is none: before valid_from, and in
/// the last look_ahead frames of each clip  @throws ShapeError
Sequences free_energy(const Mcdbn& network, const std::vector<Sequences>& modalities);

/// An estimate of Σ_i log p(v_i | the other units, H) of a machine of binary units: one unit i
/// of each frame, drawn evenly, stands for all: D · log σ(F(v with v_i flipped) − F(v)).
/// scikit-learn's BernoulliRBM.score_samples is the same.
/// @return [all frames x 1]  @throws ShapeError for Gaussian units
Sequences pseudo_log_likelihood(const Crbm& crbm, const Sequences& visible, std::uint64_t seed);

}  // namespace mcdbn
