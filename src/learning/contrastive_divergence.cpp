#include "learning/contrastive_divergence.hpp"

#include <fmt/format.h>

#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"

namespace mcdbn {
std::optional<RowTile> choose_chain_tile(const Device& device, const CrbmShape& shape,
                                         std::size_t batch) {
  return choose_row_tile(
      device, padded(shape.visible) + padded(shape.hidden), batch,
      fmt::format("Gibbs chain of {} visible, {} hidden units", shape.visible, shape.hidden));
}

CdRule cd_rule_for(const CdSettings& settings, std::size_t epoch) {
  const auto momentum =
      static_cast<float>(epoch > settings.momentum_from_epoch ? settings.momentum : 0.0);
  const auto decay = static_cast<float>(settings.weight_decay);
  CdRule rule;
  rule.gibbs_steps = settings.gibbs_steps;
  rule.W = {static_cast<float>(settings.rate), momentum, decay};
  rule.A = {static_cast<float>(settings.rate_A), momentum, decay};
  rule.B = {static_cast<float>(settings.rate_B), momentum, decay};
  return rule;
}

ContrastiveDivergence::ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch,
                                             const CdSettings& settings, OptimizerKind optimizer)
    : ContrastiveDivergence(crbm, largest_batch,
                            choose_chain_tile(crbm.device(), crbm.shape(), largest_batch), settings,
                            optimizer) {}

ContrastiveDivergence::ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch,
                                             std::optional<RowTile> tile,
                                             const CdSettings& settings, OptimizerKind optimizer)
    : crbm_(crbm),
      settings_(settings),
      tile_(tile),
      optimizer_(crbm.parameters(), optimizer),
      visible_data_(crbm.device(), whole_blocks(largest_batch, tile), crbm.shape().visible),
      visible_(Matrix::like(visible_data_)),
      visible_bias_(Matrix::like(visible_data_)),
      hidden_data_(crbm.device(), visible_data_.rows(), crbm.shape().hidden),
      hidden_(Matrix::like(hidden_data_)),
      hidden_bias_(Matrix::like(hidden_data_)),
      row_losses_(crbm.device(), 1, visible_data_.rows()) {
  if (tile_) return;
  hidden_sample_ = Matrix::like(hidden_data_);
  gradient_.emplace(crbm.parameters().in(optimizer_.gradients()));
}

void ContrastiveDivergence::learn(std::span<const Rows> visible, const LearningStep& step,
                                  LossAccumulator& losses) {
  require(visible.size() == 1, "CD: wants one sequence");
  this->step(visible.front(), cd_rule_for(settings_, step.epoch), step.random, losses);
}

void ContrastiveDivergence::step(const Rows& rows, const CdRule& rule, const RandomKey& key,
                                 LossAccumulator& losses) {
  require(rows.index != nullptr && rows.columns == crbm_.shape().visible,
          "CD: wants indexed frames, one each");
  require(rows.count > 0 && rows.count <= visible_data_.rows(),
          "CD: the mini-batch is larger than it was made for");
  require(rule.gibbs_steps > 0, "CD: wants at least one Gibbs step");
  optimizer_.next_step();
  if (!tile_) {
    composed_step(rows, rule, key, losses);
    return;
  }
  fused_chain(rows, rule.gibbs_steps, key);
  fused_update(rows, rule, losses);
}

void ContrastiveDivergence::composed_step(const Rows& rows, const CdRule& rule,
                                          const RandomKey& key, LossAccumulator& losses) {
  clamp_data(rows, key);
  gibbs_chain(rows.count, rule.gibbs_steps, key);
  const Rows data(visible_data_, 0, rows.count), reconstruction(visible_, 0, rows.count);
  losses.add_squared_error(0, data, reconstruction,
                           1.0F / static_cast<float>(rows.count * crbm_.shape().visible));
  composed_gradients(rows);
  optimizer_.update([&rule](const ParameterShape& shape) {
    return shape.name == "A" ? rule.A : shape.name == "B" ? rule.B : rule.W;
  });
  crbm_.refresh_transposed();
}

void ContrastiveDivergence::clamp_data(const Rows& rows, const RandomKey& key) {
  const Rows data(visible_data_, 0, rows.count);
  const Rows visible_bias(visible_bias_, 0, rows.count), hidden_bias(hidden_bias_, 0, rows.count);
  const Rows hidden_sample(hidden_sample_, 0, rows.count);
  gather(rows, data);
  crbm_.dynamic_visible_bias(rows, visible_bias);
  crbm_.dynamic_hidden_bias(rows, hidden_bias);
  GemmOptions hidden;
  hidden.bias = &hidden_bias_;
  hidden.activation = Activation::sigmoid;
  hidden.sampling = Sampling::bernoulli;
  hidden.sample = &hidden_sample;
  hidden.random = key;
  gemm(data, crbm_.W, Rows(hidden_data_, 0, rows.count), hidden);
}

void ContrastiveDivergence::gibbs_chain(std::size_t count, std::size_t gibbs_steps, RandomKey key) {
  const Rows visible_rows(visible_, 0, count), hidden_sample(hidden_sample_, 0, count);
  GemmOptions visible;
  visible.bias = &visible_bias_;
  if (crbm_.shape().kind == VisibleKind::binary) visible.activation = Activation::sigmoid;
  for (std::size_t k = 1; k <= gibbs_steps; ++k) {
    gemm(hidden_sample, crbm_.W_transposed, visible_rows, visible);
    GemmOptions hidden;
    hidden.bias = &hidden_bias_;
    hidden.activation = Activation::sigmoid;
    if (k < gibbs_steps) {
      hidden.sampling = Sampling::bernoulli;
      hidden.sample = &hidden_sample;
      key.phase = static_cast<std::uint16_t>(k);
      hidden.random = key;
    }
    gemm(visible_rows, crbm_.W, Rows(hidden_, 0, count), hidden);
  }
}

/// The optimizer descends: end − data.
void ContrastiveDivergence::composed_gradients(const Rows& rows) {
  const std::size_t n = rows.count;
  const float mean = 1.0F / static_cast<float>(n);
  const Rows visible_data(visible_data_, 0, n), hidden_data(hidden_data_, 0, n);
  const Rows visible(visible_, 0, n), hidden(hidden_, 0, n);
  // eq 37
  gemm_transposed_a(visible_data, hidden_data, gradient_->W, -mean);
  gemm_transposed_a(visible, hidden, gradient_->W, mean, 1.0F);
  // What the directed weights and biases learn from (eq 38 to 41, errata).
  scaled_difference(visible, visible_data, mean, visible);
  scaled_difference(hidden, hidden_data, mean, hidden);
  column_sum(visible, 1.0F, 0.0F, gradient_->a);
  column_sum(hidden, 1.0F, 0.0F, gradient_->b);
  if (crbm_.shape().order_A() > 0)
    gemm_transposed_a(crbm_.history_for_A(rows), visible, gradient_->A);
  if (crbm_.shape().order_B() > 0)
    gemm_transposed_a(crbm_.history_for_B(rows), hidden, gradient_->B);
}

CrbmParameters ContrastiveDivergence::gradients() {
  return CrbmParameters::read(crbm_.parameters().in(optimizer_.gradients()), crbm_.shape());
}

}  // namespace mcdbn
