// The launches of a fused mini-batch.

#include <cmath>

#include "device/kernel_arguments.hpp"
#include "learning/multi_prediction.hpp"

namespace mcdbn {

Defines MultiPrediction::fused_defines() const {
  return {{"VEC", tile_->vector_width},
          {"VISIBLE_0", to_int(mrbm_.visible(Modality::track))},
          {"VISIBLE_1", to_int(mrbm_.visible(Modality::pose))},
          {"HIDDEN", to_int(mrbm_.hidden())},
          {"STEPS", to_int(steps_)}};
}

void MultiPrediction::fused_gradients(const Rows& track, const Rows& pose) {
  Device& device = mrbm_.device();
  cl::Kernel& kernel = device.programs().kernel("multi_prediction.cl", "multi_prediction",
                                                with_tile(fused_defines(), *tile_));
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = block_ / static_cast<std::size_t>(tile_->rows);
  launch(device, kernel, {{blocks * group, 2}, {group, 1}}, track.matrix->buffer(),
         track.index->buffer(), to_int(track.index_first), track.shift, pose.matrix->buffer(),
         pose.index->buffer(), to_int(pose.index_first), pose.shift, to_int(batch_), to_int(block_),
         mrbm_.W[0].buffer(), mrbm_.W_transposed[0].buffer(), mrbm_.a[0].buffer(),
         mrbm_.W[1].buffer(), mrbm_.W_transposed[1].buffer(), mrbm_.a[1].buffer(), mrbm_.b.buffer(),
         target_[0].buffer(), values_[0].buffer(), value_errors_[0].buffer(), target_[1].buffer(),
         values_[1].buffer(), value_errors_[1].buffer(), hidden_.buffer(), hidden_errors_.buffer(),
         drive_.buffer(), drive_error_.buffer(), row_losses_.buffer());
}

/// Adds up the tiles of both W over pieces of the stacks. @return the pieces
std::size_t MultiPrediction::fused_products(const Defines& defines) {
  const auto vec = static_cast<std::size_t>(tile_->vector_width);
  const std::size_t tile_floats = static_cast<std::size_t>(tile_->update_rows) * vec;
  const std::size_t tiles = (padded(mrbm_.W[0].rows()) + padded(mrbm_.W[1].rows())) *
                            padded(mrbm_.hidden()) / tile_floats;
  const auto pieces_of = [](std::size_t rows) { return ceil_divide(rows, kPieceRows); };
  const std::size_t pieces =
      pieces_of(steps_ * block_) + pieces_of((steps_ - 1) * block_) + pieces_of(block_);
  Device& device = mrbm_.device();
  if (partial_.empty()) partial_ = Matrix(device, pieces, tiles * tile_floats);
  cl::Kernel& kernel =
      device.programs().kernel("multi_prediction_update.cl", "multi_prediction_products", defines);
  const auto group = static_cast<std::size_t>(tile_->group);
  launch(device, kernel, {{ceil_divide(tiles, group) * group, pieces}, {group, 1}}, to_int(block_),
         target_[0].buffer(), values_[0].buffer(), value_errors_[0].buffer(), target_[1].buffer(),
         values_[1].buffer(), value_errors_[1].buffer(), hidden_.buffer(), hidden_errors_.buffer(),
         drive_error_.buffer(), partial_.buffer());
  return pieces;
}

void MultiPrediction::fused_update(const AdamRule& rule, LossAccumulator& losses) {
  ++update_count_;
  Defines defines = fused_defines();
  defines["TILE_ROWS"] = tile_->update_rows;
  defines["PIECE_ROWS"] = to_int(kPieceRows);
  const std::size_t pieces = fused_products(defines);
  Device& device = mrbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("multi_prediction_update.cl", "multi_prediction_update", defines);
  const auto vec = static_cast<std::size_t>(tile_->vector_width);
  const auto tile_rows = static_cast<std::size_t>(tile_->update_rows);
  const std::size_t hidden = padded(mrbm_.hidden());
  const std::size_t visible = mrbm_.W[0].rows(), other_visible = mrbm_.W[1].rows();
  const std::size_t both = padded(visible) + padded(other_visible);
  const std::size_t items = both / tile_rows * (hidden / vec) + (both + hidden) / vec + 1;
  const auto group = static_cast<std::size_t>(tile_->group);
  const cl_float4 adam{{rule.rate, rule.beta1, rule.beta2, rule.epsilon}};
  const auto correction_of = [&](float beta) {
    return static_cast<float>(1.0 - std::pow(static_cast<double>(beta), update_count_));
  };
  const cl_float4 correction{
      {correction_of(rule.beta1), correction_of(rule.beta2), rule.weight_decay, 0.0F}};
  const auto& [first, second] = moments_W_;
  launch(device, kernel, {{ceil_divide(items, group) * group, 1}, {group, 1}}, to_int(block_),
         to_int(pieces), partial_.buffer(), value_errors_[0].buffer(), value_errors_[1].buffer(),
         drive_error_.buffer(), mrbm_.W[0].buffer(), mrbm_.W_transposed[0].buffer(),
         first.mean.buffer(), first.square.buffer(), gradient_W_[0].buffer(), mrbm_.W[1].buffer(),
         mrbm_.W_transposed[1].buffer(), second.mean.buffer(), second.square.buffer(),
         gradient_W_[1].buffer(), mrbm_.a[0].buffer(), moments_a_[0].mean.buffer(),
         moments_a_[0].square.buffer(), gradient_a_[0].buffer(), mrbm_.a[1].buffer(),
         moments_a_[1].mean.buffer(), moments_a_[1].square.buffer(), gradient_a_[1].buffer(),
         mrbm_.b.buffer(), moments_b_.mean.buffer(), moments_b_.square.buffer(),
         gradient_b_.buffer(), adam, correction, row_losses_.buffer(), to_int(batch_),
         losses.buffer());
}

}  // namespace mcdbn
