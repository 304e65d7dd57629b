#include "learning/contrastive_divergence.hpp"

#include <fmt/format.h>

#include "base/random_phases.hpp"
#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "learning/optimizer_of.hpp"
#include "learning/rate_schedule.hpp"
#include "machines/unit_kinds.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Share of the rates that is left.
double share_of_rate(const CdSettings& settings, double progress) {
  if (settings.cosine) return cosine_fall(progress, settings.final_rate);
  return settings.final_rate + (1.0 - settings.final_rate) * (1.0 - progress);
}

bool is_gaussian_rbm(const CrbmShape& shape) {
  return shape.order == 0 && shape.kind == VisibleKind::gaussian;
}

/// Only the composed form knows deviations.
bool has_deviation(const Crbm& crbm, const CdSettings& settings) {
  return crbm.has_deviation || learns_deviation(crbm.shape(), settings);
}

}  // namespace

bool learns_deviation(const CrbmShape& shape, const CdSettings& settings) {
  return settings.deviation_rate > 0.0 && is_gaussian_rbm(shape);
}

std::optional<RowTile> choose_chain_tile(const Device& device, const CrbmShape& shape,
                                         std::size_t batch) {
  return choose_row_tile(
      device, padded(shape.visible) + padded(shape.hidden), batch,
      fmt::format("Gibbs chain of {} visible, {} hidden units", shape.visible, shape.hidden));
}

CdRule cd_rule_for(const CdSettings& settings, std::size_t epoch, double progress) {
  // Adam corrects its mean for a first decay that has always been the same.
  const bool has_momentum = settings.adam || epoch > settings.momentum_from_epoch;
  const auto momentum = static_cast<float>(has_momentum ? settings.momentum : 0.0);
  const auto decay = static_cast<float>(settings.weight_decay);
  const double share = share_of_rate(settings, progress);
  const auto rule_of = [&](double rate) {
    UpdateRule rule{static_cast<float>(share * rate), momentum, decay};
    rule.l1 = static_cast<float>(settings.l1);
    return rule;
  };
  CdRule rule;
  rule.gibbs_steps = settings.gibbs_steps;
  rule.W = rule_of(settings.rate);
  rule.A = rule_of(settings.rate_A);
  rule.B = rule_of(settings.rate_B);
  rule.sample_visible = settings.sample_visible;
  rule.sparsity_target = static_cast<float>(settings.sparsity_target);
  rule.sparsity_strength = static_cast<float>(settings.sparsity_strength);
  rule.fast_rate = static_cast<float>(settings.fast_rate);
  rule.deviation_rate = static_cast<float>(share * settings.deviation_rate);
  return rule;
}

ContrastiveDivergence::ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch,
                                             const CdSettings& settings,
                                             std::optional<OptimizerKind> optimizer)
    : ContrastiveDivergence(crbm, largest_batch,
                            choose_chain_tile(crbm.device(), crbm.shape(), largest_batch), settings,
                            optimizer) {}

ContrastiveDivergence::ContrastiveDivergence(Crbm& crbm, std::size_t largest_batch,
                                             std::optional<RowTile> tile,
                                             const CdSettings& settings,
                                             std::optional<OptimizerKind> optimizer)
    : crbm_(crbm),
      settings_(settings),
      tile_(has_deviation(crbm, settings) ? std::nullopt : tile),
      optimizer_(crbm.parameters(), optimizer.value_or(optimizer_of(settings))),
      visible_data_(crbm.device(), whole_blocks(largest_batch, tile_), crbm.shape().visible),
      visible_(Matrix::like(visible_data_)),
      visible_bias_(Matrix::like(visible_data_)),
      hidden_data_(crbm.device(), visible_data_.rows(), crbm.shape().hidden),
      hidden_(Matrix::like(hidden_data_)),
      hidden_bias_(Matrix::like(hidden_data_)),
      row_losses_(crbm.device(), 1, visible_data_.rows()) {
  if (crbm.has_deviation && !is_gaussian_rbm(crbm.shape()))
    throw ConfigError("a deviation of its own is for a Gaussian RBM, which has no history");
  crbm.has_deviation = has_deviation(crbm, settings);
  if (tile_) return;
  hidden_sample_ = Matrix::like(hidden_data_);
  gradient_.emplace(crbm.parameters().in(optimizer_.gradients()));
}

void ContrastiveDivergence::learn(std::span<const Rows> visible, const LearningStep& step,
                                  LossAccumulator& losses) {
  require(visible.size() == 1, "CD: needs one sequence");
  this->step(visible.front(), cd_rule_for(settings_, step.epoch, step.progress), step.random,
             losses, step.seen);
}

void ContrastiveDivergence::step(const Rows& rows, const CdRule& rule, const RandomKey& key,
                                 LossAccumulator& losses, const Matrix* seen) {
  require(rows.index != nullptr && rows.columns == crbm_.shape().visible,
          "CD: needs indexed frames, one each");
  require(rows.count > 0 && rows.count <= visible_data_.rows(),
          "CD: the mini-batch is larger than it was made for");
  require(rule.gibbs_steps > 0, "CD: needs at least one Gibbs step");
  require(!seen || (seen->rows() == rows.matrix->rows() && seen->columns() == rows.columns),
          "CD: what was seen has another shape than the frames");
  require(!seen || !crbm_.has_deviation || rule.deviation_rate == 0.0F,
          "CD: a deviation is learnt from frames that were seen whole");
  seen_ = seen;
  optimizer_.next_step();
  run_chain(rows, rule, key);
  if (!tile_) add_loss(rows.count, losses);
  if (crbm_.has_deviation && rule.deviation_rate > 0.0F)
    learn_deviation(rows.count, rule.deviation_rate);
  if (rule.sparsity_strength > 0.0F) pull_to_target(rows.count, rule);
  if (tile_)
    fused_update(rows, rule, losses);
  else
    composed_update(rows, rule);
  after_update(rule);
}

void ContrastiveDivergence::run_chain(const Rows& rows, const CdRule& rule, const RandomKey& key) {
  if (tile_) {
    fused_chain(rows, rule, key);
    return;
  }
  clamp_data(rows, key);
  gibbs_chain(crbm_, rows.count, rule, key);
}

void ContrastiveDivergence::after_update(const CdRule&) {}

void ContrastiveDivergence::visit_state(TrainingState& state) {
  optimizer_.visit_state(state);
  state.matrix_if_any("activity", activity_,
                      [this] { return Matrix(crbm_.device(), 1, crbm_.shape().hidden); });
}

void ContrastiveDivergence::pull_to_target(std::size_t count, const CdRule& rule) {
  constexpr float kActivityKept = 0.9F;
  const bool is_first = activity_.empty();
  if (is_first) activity_ = Matrix(crbm_.device(), 1, crbm_.shape().hidden);
  Device& device = crbm_.device();
  const int width = vector_width(device);
  // The fused chain leaves its change in hidden_bias_; the composed one needs it no more.
  launch(device, device.programs().kernel("unit_statistics.cl", "pull_to_target", {{"VEC", width}}),
         {{hidden_data_.stride() / static_cast<std::size_t>(width), 1}}, hidden_data_.buffer(),
         hidden_bias_.buffer(), to_int(hidden_data_.stride()), to_int(count),
         to_int(hidden_data_.columns()), is_first ? 0.0F : kActivityKept, rule.sparsity_target,
         rule.sparsity_strength, activity_.buffer());
}

void ContrastiveDivergence::learn_deviation(std::size_t count, float rate) {
  GemmOptions down;
  down.bias = &crbm_.a;
  gemm(Rows(hidden_data_, 0, count), crbm_.W_transposed, Rows(visible_bias_, 0, count), down);
  Device& device = crbm_.device();
  const int width = vector_width(device);
  launch(device,
         device.programs().kernel("unit_statistics.cl", "deviation_update", {{"VEC", width}}),
         {{visible_data_.stride() / static_cast<std::size_t>(width), 1}}, visible_data_.buffer(),
         visible_bias_.buffer(), to_int(visible_data_.stride()), to_int(count),
         to_int(visible_data_.columns()), rate, crbm_.visible_deviation.buffer());
}

/// While the deviation is still the one that the units are over.
void ContrastiveDivergence::add_loss(std::size_t count, LossAccumulator& losses) {
  losses.add_squared_error(0, Rows(visible_data_, 0, count), Rows(visible_, 0, count),
                           1.0F / static_cast<float>(count * crbm_.shape().visible),
                           crbm_.has_deviation ? &crbm_.visible_deviation : nullptr);
}

void ContrastiveDivergence::composed_update(const Rows& rows, const CdRule& rule) {
  composed_gradients(rows);
  optimizer_.update([&rule](const ParameterShape& shape) {
    return shape.name == "A" ? rule.A : shape.name == "B" ? rule.B : rule.W;
  });
  crbm_.refresh_transposed();
}

void ContrastiveDivergence::clamp_data(const Rows& rows, const RandomKey& key) {
  const Rows data(visible_data_, 0, rows.count);
  const Rows hidden_sample(hidden_sample_, 0, rows.count);
  gather(rows, data);
  if (seen_) {
    if (visible_seen_.empty()) visible_seen_ = Matrix::like(visible_data_);
    Rows those = rows;
    those.matrix = seen_;
    gather(those, Rows(visible_seen_, 0, rows.count));
  }
  if (crbm_.has_deviation) scale_columns(data, crbm_.visible_deviation, true);
  dynamic_biases(crbm_, rows);
  GemmOptions hidden = mean_of_units(VisibleKind::binary);
  hidden.bias = &hidden_bias_;
  hidden.sampling = sampling_of(VisibleKind::binary);
  hidden.sample = &hidden_sample;
  hidden.random = key;
  gemm(data, crbm_.W, Rows(hidden_data_, 0, rows.count), hidden);
}

void ContrastiveDivergence::dynamic_biases(const Crbm& machine, const Rows& rows) {
  machine.dynamic_visible_bias(rows, Rows(visible_bias_, 0, rows.count));
  machine.dynamic_hidden_bias(rows, Rows(hidden_bias_, 0, rows.count));
}

void ContrastiveDivergence::gibbs_chain(const Crbm& machine, std::size_t count, const CdRule& rule,
                                        RandomKey key, bool draw_last) {
  const Rows visible_rows(visible_, 0, count), hidden_sample(hidden_sample_, 0, count);
  GemmOptions visible = mean_of_units(machine.shape().kind);
  visible.bias = &visible_bias_;
  if (rule.sample_visible) {
    visible.sampling = sampling_of(machine.shape().kind);
    visible.sample = &visible_rows;  // in place of the means
  }
  const std::uint16_t first_phase = key.phase;
  for (std::size_t k = 1; k <= rule.gibbs_steps; ++k) {
    const auto step = static_cast<std::uint16_t>(first_phase + k);
    key.phase = static_cast<std::uint16_t>(random_phases::kVisibleUnits + step);
    visible.random = key;
    gemm(hidden_sample, machine.W_transposed, visible_rows, visible);
    if (seen_) multiply(visible_rows, Rows(visible_seen_, 0, count));
    GemmOptions hidden = mean_of_units(VisibleKind::binary);
    hidden.bias = &hidden_bias_;
    if (k < rule.gibbs_steps || draw_last) {
      hidden.sampling = sampling_of(VisibleKind::binary);
      hidden.sample = &hidden_sample;
      key.phase = step;
      hidden.random = key;
    }
    gemm(visible_rows, machine.W, Rows(hidden_, 0, count), hidden);
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
