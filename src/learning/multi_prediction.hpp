#pragma once

#include "device/losses.hpp"
#include "device/program.hpp"
#include "device/row_tile.hpp"
#include "device/updates.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// Multi-prediction MinVI training of the MRBM (eq 42; Goodfellow et al., Sohn et al.): each
/// modality is predicted from the other by the unrolled mean field of eq 32 and 33, and the
/// cross-entropy of that prediction is back-propagated through all steps, in both directions.
///
/// A mini-batch is three launches (multi_prediction.cl, multi_prediction_update.cl) where a block
/// of rows fits the device's local memory, else one product after another.
class MultiPrediction {
 public:
  MultiPrediction(Mrbm& mrbm, std::size_t mean_field_steps, std::size_t batch);
  /// With a tile of the caller's, or without the fused kernels.
  MultiPrediction(Mrbm& mrbm, std::size_t mean_field_steps, std::size_t batch,
                  std::optional<RowTile> tile);

  /// One mini-batch with its Adam update: enqueues and returns. Adds to `losses` the mean
  /// cross-entropy of a unit: slot 0 for pose from track, slot 1 for track from pose.
  /// @param track, pose the same windows' codes, indexed, `batch` of them  @throws ShapeError
  void step(const Rows& track, const Rows& pose, const AdamRule& rule, LossAccumulator& losses);

  /// The gradients of eq 42 (mean over the mini-batch, summed over both directions) as the last
  /// step left them, for tests.
  MrbmParameters gradients() const;

 private:
  /// Gradients of −log p(absent | present), added to those of the other direction if `add`.
  void back_propagate(Modality present, std::size_t count, bool add, LossAccumulator& losses);
  void update(const AdamRule& rule);

  void fused_gradients(const Rows& track, const Rows& pose);
  std::size_t fused_products(const Defines& defines);
  void fused_update(const AdamRule& rule, LossAccumulator& losses);
  Defines fused_defines() const;

  /// Rows of the stacks that are added up at once: two pieces should fit a core's cache.
  static constexpr std::size_t kPieceRows = 1024;

  Mrbm& mrbm_;
  std::size_t steps_, batch_;
  std::optional<RowTile> tile_;
  std::size_t block_;  ///< rows of one mean-field step in the stacks: the batch, or whole blocks
  int update_count_ = 0;
  std::array<Matrix, 2> target_;                 // [block x visible]
  std::array<Matrix, 2> values_, value_errors_;  // [steps·block x visible]; composed: zeros first
  // Composed: of one direction; fused: of both, one after the other.
  Matrix drive_, drive_error_;     // [block x hidden]
  Matrix hidden_, hidden_errors_;  // [steps·block x hidden]
  Matrix row_losses_;              // [1 x 2·block], fused
  Matrix partial_;                 // [pieces x floats of both W], fused
  std::array<Matrix, 2> gradient_W_, gradient_a_;
  Matrix gradient_b_;
  struct Moments {
    Matrix mean, square;
  };
  std::array<Moments, 2> moments_W_, moments_a_;
  Moments moments_b_;
};

}  // namespace mcdbn
