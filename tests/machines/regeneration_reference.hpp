#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "reference/running_error.hpp"

/// Algorithms 3 and 5 in double precision with bounds, straight from the equations: what
/// regenerate() and the decoder promise, with the device's own draws.
namespace mcdbn::reference {

/// How units are drawn (all fields as in RegenerationOptions and SamplingRule).
struct DrawRule {
  double share = 0.0;  ///< of the draw: mean + share · (draw − mean); 0 draws nothing
  std::size_t gibbs_steps = 0;
  std::size_t mrbm_gibbs_steps = 0;
  bool steady = false;
  std::uint64_t seed = 1;
};

/// Frames of many sequences in step: by frame, [sequences x units].
using Frames = std::vector<Bounded>;

/// The down-pass of a whole stack with its code clamped, frames first … last − 1. The draws are
/// those of row = sequence, step = frame, stream 200, phase 2k for the units below and 2k + 1 for
/// the top ones.
/// @return the lowest layer's visible units; before `first` its mean
Frames decoded(const std::vector<CrbmParameters>& layers, const Frames& code, std::size_t first,
               std::size_t last, const DrawRule& rule);

struct Network {
  std::vector<CrbmParameters> track, pose;
  MrbmParameters mrbm;
  std::size_t look_ahead = 0, mean_field_steps = 1;
};

/// @return [frames x pose dimension] for track 0's samples, then track 1's …
std::vector<Bounded> regenerated(const Network& network, const std::vector<MatrixF>& tracks,
                                 std::size_t samples, std::size_t run_in, const DrawRule& rule);

}  // namespace mcdbn::reference
