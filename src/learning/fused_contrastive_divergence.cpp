// The two launches of a fused mini-batch.

#include "device/kernel_arguments.hpp"
#include "learning/contrastive_divergence.hpp"
#include "machines/crbm_defines.hpp"

namespace mcdbn {
namespace {

/// The first floats of W, A, B, a and b.
cl_int8 first_floats(const Parameters& parameters) {
  const auto first = [&](const char* name) { return to_int(parameters.entry(name).first); };
  return {{first("W"), first("A"), first("B"), first("a"), first("b"), 0, 0, 0}};
}

/// Panels of W, A and B, then a work-item for each vector of the biases, and one for the losses.
std::size_t update_groups(const CrbmShape& shape, const RowTile& tile) {
  const std::size_t visible = padded(shape.visible), hidden = padded(shape.hidden);
  const auto vec = static_cast<std::size_t>(tile.vector_width);
  return update_panels(tile, visible) + update_panels(tile, shape.order_A() * visible) +
         update_panels(tile, shape.order_B() * visible) +
         ceil_divide((visible + hidden) / vec + 1, static_cast<std::size_t>(tile.group));
}

}  // namespace

void ContrastiveDivergence::fused_chain(const Rows& rows, const CdRule& rule, const RandomKey& key,
                                        const Matrix* particles, bool fresh) {
  const CrbmShape& shape = crbm_.shape();
  Defines defines = crbm_row_defines(shape, *tile_);
  if (rule.sample_visible) defines["SAMPLE_VISIBLE"] = 1;
  if (particles) defines["PERSISTENT"] = 1;
  if (seen_) defines["MASKED"] = 1;
  Device& device = crbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("contrastive_divergence.cl", "gibbs_chain", defines);
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = ceil_divide(rows.count, static_cast<std::size_t>(tile_->rows));
  launch(device, kernel, {{blocks * group, 1}, {group, 1}}, rows.matrix->buffer(),
         rows.index->buffer(), to_int(rows.index_first), rows.shift, to_int(rows.count),
         crbm_.parameters().all().buffer(), first_floats(crbm_.parameters()),
         crbm_.W_transposed.buffer(), visible_data_.buffer(), visible_.buffer(),
         visible_bias_.buffer(), hidden_data_.buffer(), hidden_.buffer(), hidden_bias_.buffer(),
         row_losses_.buffer(), to_int(rule.gibbs_steps), random_argument(key),
         (particles ? *particles : hidden_).buffer(), fresh ? 1 : 0,
         (seen_ ? *seen_ : visible_data_).buffer());
}

void ContrastiveDivergence::fused_update(const Rows& rows, const CdRule& rule,
                                         LossAccumulator& losses) {
  const CrbmShape& shape = crbm_.shape();
  Defines defines = with_update_tile(crbm_defines(shape, *tile_), *tile_);
  defines["OPTIMIZER"] = optimizer_.define(rule.W.l1 + rule.A.l1 + rule.B.l1 > 0.0F);
  Device& device = crbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("contrastive_divergence_update.cl", "cd_update", defines);
  const float loss_scale = 1.0F / static_cast<float>(rows.count * shape.visible);
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t groups = update_groups(shape, *tile_);
  // Sums that wait for the next chunk do so where gradients lie.
  const cl::Buffer& gradients =
      rows.count > kUpdateChunk ? optimizer_.gradients().buffer() : optimizer_.gradient_buffer();
  launch(device, kernel, {{groups * group, 1}, {group, 1}}, rows.matrix->buffer(),
         rows.index->buffer(), to_int(rows.index_first), rows.shift, to_int(rows.count),
         visible_data_.buffer(), visible_.buffer(), visible_bias_.buffer(), hidden_data_.buffer(),
         hidden_.buffer(), hidden_bias_.buffer(), first_floats(crbm_.parameters()),
         crbm_.parameters().all().buffer(), crbm_.W_transposed.buffer(), gradients,
         optimizer_.state_buffer(), optimizer_.size(), optimizer_.argument(rule.W),
         optimizer_.argument(rule.A), optimizer_.argument(rule.B), row_losses_.buffer(),
         losses.buffer(), loss_scale);
}

}  // namespace mcdbn
