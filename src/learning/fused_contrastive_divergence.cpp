// The two launches of a fused mini-batch.

#include "device/kernel_arguments.hpp"
#include "learning/contrastive_divergence.hpp"

namespace mcdbn {
namespace {

Defines shape_defines(const CrbmShape& shape, const RowTile& tile) {
  return {{"VEC", tile.vector_width},
          {"VISIBLE", to_int(shape.visible)},
          {"HIDDEN", to_int(shape.hidden)},
          {"ORDER", to_int(shape.order)}};
}

cl_float4 rule_argument(const MomentumRule& rule) {
  return {{rule.rate, rule.momentum, rule.weight_decay, 0.0F}};
}

/// A matrix without elements has no buffer; the kernels do not read it, but want one.
const cl::Buffer& buffer_of(const Matrix& matrix, const Matrix& substitute) {
  return matrix.empty() ? substitute.buffer() : matrix.buffer();
}

std::size_t update_work_items(const CrbmShape& shape, const RowTile& tile) {
  const std::size_t visible = padded(shape.visible), hidden = padded(shape.hidden);
  const auto vec = static_cast<std::size_t>(tile.vector_width);
  const auto rows = static_cast<std::size_t>(tile.update_rows);
  const std::size_t vectors = (visible + hidden) / vec;
  return visible / rows * (hidden / vec) + shape.order * visible / rows * vectors + vectors + 1;
}

}  // namespace

void ContrastiveDivergence::fused_chain(const Rows& rows, std::size_t gibbs_steps,
                                        const RandomKey& key) {
  const CrbmShape& shape = crbm_.shape();
  Defines defines = with_tile(shape_defines(shape, *tile_), *tile_);
  defines["GAUSSIAN"] = shape.kind == VisibleKind::gaussian ? 1 : 0;
  Device& device = crbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("contrastive_divergence.cl", "gibbs_chain", defines);
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = ceil_divide(rows.count, static_cast<std::size_t>(tile_->rows));
  launch(device, kernel, {{blocks * group, 1}, {group, 1}}, rows.matrix->buffer(),
         rows.index->buffer(), to_int(rows.index_first), rows.shift, to_int(rows.count),
         crbm_.W.buffer(), crbm_.W_transposed.buffer(), buffer_of(crbm_.A, crbm_.W),
         buffer_of(crbm_.B, crbm_.W), crbm_.a.buffer(), crbm_.b.buffer(), visible_data_.buffer(),
         visible_.buffer(), visible_bias_.buffer(), hidden_data_.buffer(), hidden_.buffer(),
         hidden_bias_.buffer(), row_losses_.buffer(), to_int(gibbs_steps), random_argument(key));
}

void ContrastiveDivergence::fused_update(const Rows& rows, const CdRule& rule,
                                         LossAccumulator& losses) {
  const CrbmShape& shape = crbm_.shape();
  Defines defines = shape_defines(shape, *tile_);
  defines["TILE_ROWS"] = tile_->update_rows;
  Device& device = crbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("contrastive_divergence_update.cl", "cd_update", defines);
  const float loss_scale = 1.0F / static_cast<float>(rows.count * shape.visible);
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t groups = ceil_divide(update_work_items(shape, *tile_), group);
  launch(device, kernel, {{groups * group, 1}, {group, 1}}, rows.matrix->buffer(),
         rows.index->buffer(), to_int(rows.index_first), rows.shift, to_int(rows.count),
         visible_data_.buffer(), visible_.buffer(), visible_bias_.buffer(), hidden_data_.buffer(),
         hidden_.buffer(), hidden_bias_.buffer(), crbm_.W.buffer(), crbm_.W_transposed.buffer(),
         buffer_of(crbm_.A, crbm_.W), buffer_of(crbm_.B, crbm_.W), crbm_.a.buffer(),
         crbm_.b.buffer(), velocity_W_.buffer(), buffer_of(velocity_A_, crbm_.W),
         buffer_of(velocity_B_, crbm_.W), velocity_a_.buffer(), velocity_b_.buffer(),
         rule_argument(rule.W), rule_argument(rule.A), rule_argument(rule.B), row_losses_.buffer(),
         losses.buffer(), loss_scale);
}

}  // namespace mcdbn
