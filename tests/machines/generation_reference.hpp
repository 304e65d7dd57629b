#pragma once

#include <vector>

#include "mcdbn/machines/generation.hpp"
#include "reference/running_error.hpp"

/// Algorithm 4 in double precision with bounds, straight from the equations: what generate()
/// promises, with the device's own draws.
namespace mcdbn::reference {

/// The same moment of many sequences, one a row [sequences x units], for each moment.
using Moments = std::vector<Bounded>;

/// Goes on with the sequences of one layer by `options.frames`: Gibbs steps under its own history.
/// The draws are those of row = sequence, step = new frame, stream 206, phase = Gibbs step.
void run_freely(const CrbmParameters& layer, Moments& visible, const GenerationOptions& options);

/// @return [frames x visible] for seed 0's samples, then seed 1's …
std::vector<Bounded> generated(const std::vector<CrbmParameters>& layers,
                               const std::vector<MatrixF>& seeds, const GenerationOptions& options);

}  // namespace mcdbn::reference
