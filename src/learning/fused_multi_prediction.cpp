// The launches of a fused mini-batch.

#include <algorithm>

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

Defines MultiPrediction::update_defines() const {
  Defines defines = with_update_tile(fused_defines(), *tile_);
  defines["PIECE_STEPS"] = to_int(piece_steps());
  defines["OPTIMIZER"] = optimizer_.define();
  return defines;
}

/// By the rows of a part, not of whole blocks: sums must not depend on the tile.
std::size_t MultiPrediction::piece_steps() const {
  return std::max<std::size_t>(1, kPieceRows / part_rows_);
}

std::size_t MultiPrediction::pieces() const {
  return ceil_divide(steps_, piece_steps()) + ceil_divide(steps_ - 1, piece_steps()) +
         mrbm_.W.size() - 1;
}

void MultiPrediction::fused_step(const std::vector<Rows>& codes, const UpdateRule& rule,
                                 LossAccumulator& losses) {
  for (std::size_t first = 0; first < batch_; first += part_rows_) {
    const std::size_t rows = std::min(part_rows_, batch_ - first);
    const Part part{first, rows, whole_blocks(rows, tile_)};
    std::vector<Rows> own = codes;
    for (Rows& of_modality : own) {
      of_modality.index_first += first;
      of_modality.count = rows;
    }
    gather_codes(own, part.stride, codes_);
    fused_chain(part);
    fused_products(part);
  }
  fused_update(rule, losses);
}

void MultiPrediction::fused_chain(const Part& part) {
  Device& device = mrbm_.device();
  cl::Kernel& kernel = device.programs().kernel("multi_prediction.cl", "multi_prediction",
                                                with_tile(fused_defines(), *tile_));
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = part.stride / static_cast<std::size_t>(tile_->rows);
  launch(device, kernel, {{blocks * group, mrbm_.W.size()}, {group, 1}}, mrbm_.layout().buffer(),
         to_int(part.rows), to_int(part.stride), to_int(part.first), to_int(batch_),
         mrbm_.parameters().all().buffer(), mrbm_.transposed().all().buffer(), codes_.buffer(),
         stacked_values_.buffer(), stacked_value_errors_.buffer(), hidden_.buffer(),
         hidden_errors_.buffer(), present_input_.buffer(), present_input_error_.buffer(),
         row_losses_.buffer());
}

/// Adds up the tiles of every W over pieces of a part's stacks, and the biases' gradients.
void MultiPrediction::fused_products(const Part& part) {
  Device& device = mrbm_.device();
  cl::Kernel& kernel = device.programs().kernel("multi_prediction_update.cl",
                                                "multi_prediction_products", update_defines());
  const auto group = static_cast<std::size_t>(tile_->group);
  launch(device, kernel, {{all_panels(mrbm_, *tile_) * group, pieces() + 1}, {group, 1}},
         mrbm_.layout().buffer(), to_int(part.stride), part.first > 0 ? 1 : 0, codes_.buffer(),
         stacked_values_.buffer(), stacked_value_errors_.buffer(), hidden_.buffer(),
         hidden_errors_.buffer(), present_input_error_.buffer(), partial_.buffer(),
         to_int(all_units(mrbm_)));
}

void MultiPrediction::fused_update(const UpdateRule& rule, LossAccumulator& losses) {
  Device& device = mrbm_.device();
  cl::Kernel& kernel = device.programs().kernel("multi_prediction_update.cl",
                                                "multi_prediction_update", update_defines());
  const auto vec = static_cast<std::size_t>(tile_->vector_width);
  const auto tile_rows = static_cast<std::size_t>(tile_->update_rows);
  const std::size_t hidden = padded(mrbm_.hidden()), units = all_units(mrbm_);
  const std::size_t items = units / tile_rows * (hidden / vec) + (units + hidden) / vec + 1;
  const auto group = static_cast<std::size_t>(tile_->group);
  launch(device, kernel, {{ceil_divide(items, group) * group, 1}, {group, 1}},
         mrbm_.layout().buffer(), to_int(batch_), to_int(pieces()), to_int(units),
         partial_.buffer(), mrbm_.parameters().all().buffer(), mrbm_.transposed().all().buffer(),
         optimizer_.gradient_buffer(), optimizer_.state_buffer(), optimizer_.size(),
         optimizer_.argument(rule), row_losses_.buffer(), losses.buffer());
}

}  // namespace mcdbn
