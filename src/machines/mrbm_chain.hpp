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
  /// The first pass counts the present modality twice in place of the absent one's zeros (Sohn et
  /// al.).
  bool doubled = false;
  Sampling sampling = Sampling::bernoulli;  ///< or concrete
  /// The draws are those of row r of the chain, with phase 2 · step for the hidden units and
  /// 2 · step + 1 for the absent ones.
  RandomKey random = {};
};

/// What mrbm_shape.clh wants but for STEPS.
Defines shape_defines(const Mrbm& mrbm);

/// The MRBM's chain with one modality clamped to what is present (Algorithm 5's inference): `steps`
/// times the shared hidden units from both modalities, then the absent modality from them. The
/// absent modality starts from zeros; what comes out is p(absent | hidden) of the last step, not
/// drawn.
///
/// A chain is one launch (mrbm_inference.cl) where a row's state fits the device's local memory,
/// else two products a step. Both give the same bits, unless CLBlast multiplies.
class MrbmChain {
 public:
  /// @param present the modality that is clamped  @param largest_rows of one run
  MrbmChain(const Mrbm& mrbm, Modality present, std::size_t largest_rows);
  /// With a tile of the caller's, or without the fused kernel.
  MrbmChain(const Mrbm& mrbm, Modality present, std::size_t largest_rows,
            std::optional<RowTile> tile);

  /// Enqueues and returns.
  /// @param present [rows x visible(present)], possibly indexed
  /// @param absent [rows x visible(other)], not indexed, no rows of `present`: the result
  /// @throws ShapeError, also for more rows than it was made for, or no steps
  void run(const Rows& present, const MrbmChainOptions& options, const Rows& absent);

  /// Unset where chains are composed.
  const std::optional<RowTile>& tile() const { return tile_; }

 private:
  void fused(const Rows& present, const MrbmChainOptions& options, const Rows& absent);
  void composed(const Rows& present, const MrbmChainOptions& options, const Rows& absent);

  const Mrbm& mrbm_;
  std::size_t present_, absent_;  ///< indices of the modalities
  std::size_t largest_rows_;
  std::optional<RowTile> tile_;
  Matrix drive_;   ///< what the present modality says to the hidden units [rows x hidden]
  Matrix hidden_;  ///< [rows x hidden], composed
};

}  // namespace mcdbn
