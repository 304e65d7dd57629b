#pragma once

#include <optional>
#include <vector>

#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// Early signs that a layer goes wrong. Computed on the host, from a few windows.
struct LayerHealth {
  double hidden_activity = 0;  ///< mean hidden probability
  double saturation = 0;       ///< fraction of hidden probabilities below 0.01 or above 0.99
  double weight_norm = 0;      ///< Frobenius norm of W (of all W of an MRBM)
  std::optional<double> weight_norm_A, weight_norm_B;  ///< of a CRBM
  /// Mean squared error of a unit, in the data's units, when the CRBM goes on by itself, mean
  /// field, for kFreeRunFrames after a true history. Unset if no clip is long enough, and for an
  /// MRBM.
  std::optional<double> free_run_error;
};

inline constexpr std::size_t kFreeRunFrames = 10;
inline constexpr std::size_t kHealthWindows = 16;

/// At most kHealthWindows windows, evenly over all frames. @return [frames x dimension] each
std::vector<MatrixF> health_windows(const Sequences& sequences, std::size_t frames);

/// Windows for crbm_health(): of order + kFreeRunFrames frames or, where no clip has so many, of
/// order + 1. @return [frames x dimension] each
std::vector<MatrixF> crbm_health_windows(const Sequences& sequences, std::size_t order);

/// @param windows of order + kFreeRunFrames frames, or fewer but at least order + 1, which leaves
///        free_run_error unset [frames x visible]
LayerHealth crbm_health(const CrbmParameters& parameters, std::vector<MatrixF> windows);

/// @param codes of the same frames [rows x visible of the modality]
LayerHealth mrbm_health(const MrbmParameters& parameters, const std::vector<MatrixF>& codes);

}  // namespace mcdbn
