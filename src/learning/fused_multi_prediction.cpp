// The launches of a fused mini-batch.

#include "device/kernel_arguments.hpp"
#include "learning/code_stack.hpp"
#include "learning/multi_prediction.hpp"
#include "machines/mrbm_chain.hpp"

namespace mcdbn {

Defines MultiPrediction::fused_defines() const {
  Defines defines = shape_defines(mrbm_);
  defines["VEC"] = tile_->vector_width;
  defines["STEPS"] = to_int(steps_);
  return defines;
}

void MultiPrediction::fused_chain() {
  Device& device = mrbm_.device();
  cl::Kernel& kernel = device.programs().kernel("multi_prediction.cl", "multi_prediction",
                                                with_tile(fused_defines(), *tile_));
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = block_ / static_cast<std::size_t>(tile_->rows);
  launch(device, kernel, {{blocks * group, mrbm_.W.size()}, {group, 1}}, mrbm_.layout().buffer(),
         to_int(batch_), to_int(block_), mrbm_.parameters().all().buffer(),
         mrbm_.transposed().all().buffer(), codes_.buffer(), stacked_values_.buffer(),
         stacked_value_errors_.buffer(), hidden_.buffer(), hidden_errors_.buffer(), drive_.buffer(),
         drive_error_.buffer(), row_losses_.buffer());
}

/// Adds up the tiles of every W over pieces of the stacks. @return the pieces
std::size_t MultiPrediction::fused_products(const Defines& defines) {
  const auto pieces_of = [](std::size_t rows) { return ceil_divide(rows, kPieceRows); };
  const std::size_t pieces = pieces_of(steps_ * block_) + pieces_of((steps_ - 1) * block_) +
                             (mrbm_.W.size() - 1) * pieces_of(block_);
  Device& device = mrbm_.device();
  if (partial_.empty()) partial_ = Matrix(device, pieces * all_units(mrbm_), mrbm_.hidden());
  cl::Kernel& kernel =
      device.programs().kernel("multi_prediction_update.cl", "multi_prediction_products", defines);
  const auto group = static_cast<std::size_t>(tile_->group);
  launch(device, kernel, {{all_panels(mrbm_, *tile_) * group, pieces}, {group, 1}},
         mrbm_.layout().buffer(), to_int(block_), codes_.buffer(), stacked_values_.buffer(),
         stacked_value_errors_.buffer(), hidden_.buffer(), hidden_errors_.buffer(),
         drive_error_.buffer(), partial_.buffer(), to_int(all_units(mrbm_)));
  return pieces;
}

void MultiPrediction::fused_update(const UpdateRule& rule, LossAccumulator& losses) {
  Defines defines = with_update_tile(fused_defines(), *tile_);
  defines["PIECE_ROWS"] = to_int(kPieceRows);
  defines["OPTIMIZER"] = optimizer_.define();
  const std::size_t pieces = fused_products(defines);
  Device& device = mrbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("multi_prediction_update.cl", "multi_prediction_update", defines);
  const auto vec = static_cast<std::size_t>(tile_->vector_width);
  const auto tile_rows = static_cast<std::size_t>(tile_->update_rows);
  const std::size_t hidden = padded(mrbm_.hidden()), units = all_units(mrbm_);
  const std::size_t items = units / tile_rows * (hidden / vec) + (units + hidden) / vec + 1;
  const auto group = static_cast<std::size_t>(tile_->group);
  launch(device, kernel, {{ceil_divide(items, group) * group, 1}, {group, 1}},
         mrbm_.layout().buffer(), to_int(batch_), to_int(block_), to_int(pieces),
         to_int(all_units(mrbm_)), partial_.buffer(), stacked_value_errors_.buffer(),
         drive_error_.buffer(), mrbm_.parameters().all().buffer(),
         mrbm_.transposed().all().buffer(), optimizer_.gradient_buffer(), optimizer_.state_buffer(),
         optimizer_.size(), optimizer_.argument(rule), row_losses_.buffer(), losses.buffer());
}

}  // namespace mcdbn
