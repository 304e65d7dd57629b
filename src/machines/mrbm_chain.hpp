#pragma once

#include <optional>

#include "device/gemm.hpp"
#include "device/row_tile.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

struct MrbmChainOptions {
  std::size_t steps = 1;  ///< k: passes to the hidden units and back, at least one
  /// 0: mean field (eq 32, 33). 1: sampled (eq 21 to 23). Between: each draw pulled towards its
  /// probability p, as p + temperature · (draw − p).
  float temperature = 0.0F;
  Sampling sampling = Sampling::bernoulli;  ///< or concrete; Gaussian units draw as such
  /// The draws are those of row r of the chain. Each step has a phase for the hidden units, then
  /// one for each absent modality. After random_phases::kPhasesOfChain they begin anew, with a
  /// `RandomKey::step` that is `steps_apart` further on.
  RandomKey random = {};
  std::uint32_t steps_apart = 1;
};

/// Definitions for mrbm_shape.clh, without STEPS.
Defines shape_defines(const Mrbm& mrbm);

/// The MRBM's chain with some modalities clamped to what is present (Algorithm 5's inference):
/// `steps` times the shared hidden units from all modalities, then the absent ones from them.
/// Absent modalities start from zeros; what comes out is their mean given the hidden units of the
/// last step, not drawn.
///
/// A chain is one launch (mrbm_inference.cl) where one binary modality is given another and a row's
/// state fits the device's local memory, else some products a step. Both give the same bits, unless
/// CLBlast multiplies.
class MrbmChain {
 public:
  /// @param present of each modality, whether it is clamped; one at least is not
  /// @param largest_rows of one run  @throws ShapeError
  MrbmChain(const Mrbm& mrbm, const std::vector<bool>& present, std::size_t largest_rows);
  /// With a tile of the caller's, or without the fused kernel.
  MrbmChain(const Mrbm& mrbm, const std::vector<bool>& present, std::size_t largest_rows,
            std::optional<RowTile> tile);

  /// Enqueues and returns.
  /// @param modalities [rows x visible] of each: the present ones, possibly indexed, are read; the
  ///        absent ones, not indexed and other rows than any present one, are the result
  /// @throws ShapeError, also for more rows than it was made for, or no steps
  void run(const std::vector<Rows>& modalities, const MrbmChainOptions& options);

  /// Unset where chains are composed.
  const std::optional<RowTile>& tile() const { return tile_; }

 private:
  void check(const std::vector<Rows>& modalities, const MrbmChainOptions& options) const;
  void fused(const Rows& present, const MrbmChainOptions& options, const Rows& absent);
  void composed(const std::vector<Rows>& modalities, const MrbmChainOptions& options);

  const Mrbm& mrbm_;
  std::vector<std::size_t> present_, absent_;  ///< indices of the modalities
  std::size_t largest_rows_;
  std::optional<RowTile> tile_;
  Matrix present_input_;  ///< b and the present modalities' products [rows x hidden]
  Matrix hidden_;         ///< [rows x hidden], composed
};

}  // namespace mcdbn
