#pragma once

#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/generation.hpp"

namespace mcdbn {

/// The top layer of a CDBN on its own output (Algorithm 4, lines 7 and 8): fills in frames `first`,
/// first + 1 … of every sequence. Draws are those of row = sequence, step = new frame, phase =
/// Gibbs step, both from 0, stream kGeneration. One launch (cdbn_generation.cl), or some launches a
/// frame where its state does not fit the device's local memory. Enqueues and returns.
/// @param state visible units [sequences·frames x visible], one sequence after another, of which
///        those before `first` are the seed
/// @param fused false: some launches a frame, wherever it would fit
/// @throws ShapeError if `first` leaves less than the order, or not even one frame, as a seed
void run_freely(const Crbm& crbm, const Matrix& state, std::size_t sequences, std::size_t first,
                const GenerationOptions& options, bool fused = true);

}  // namespace mcdbn
