#include "learning/multi_prediction.hpp"

#include <algorithm>

#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "learning/code_stack.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/mrbm_rule.hpp"
#include "machines/mean_field.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::optional<RowTile> choose_tile(const Mrbm& mrbm, std::size_t batch) {
  CrbmShape shape;
  for (const Modality& modality : mrbm.shape().modalities)
    shape.visible = std::max(shape.visible, modality.visible);
  shape.hidden = mrbm.hidden();
  return choose_chain_tile(mrbm.device(), shape, batch);
}

/// Parts as long as each other, but for the last. A GPU needs as many rows at once as there are.
std::size_t rows_of_part(const Device& device, std::size_t batch, std::size_t most_on_cpu) {
  if (device.info().is_gpu) return batch;
  return ceil_divide(batch, std::max<std::size_t>(1, ceil_divide(batch, most_on_cpu)));
}

std::vector<std::size_t> all_but(std::size_t modality, std::size_t modalities) {
  std::vector<std::size_t> others;
  for (std::size_t m = 0; m < modalities; ++m)
    if (m != modality) others.push_back(m);
  return others;
}

}  // namespace

MultiPrediction::MultiPrediction(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                                 OptimizerKind optimizer)
    : MultiPrediction(mrbm, batch, settings,
                      choose_tile(mrbm, rows_of_part(mrbm.device(), batch, kMostPartRows)),
                      optimizer) {}

MultiPrediction::MultiPrediction(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                                 std::optional<RowTile> tile, OptimizerKind optimizer)
    : mrbm_(mrbm),
      settings_(settings),
      steps_(settings.mean_field_steps),
      batch_(batch),
      part_rows_(tile ? rows_of_part(mrbm.device(), batch, kMostPartRows) : batch),
      tile_(tile),
      block_(whole_blocks(part_rows_, tile)),
      optimizer_(mrbm.parameters(), optimizer),
      present_input_(mrbm.device(), (tile ? mrbm.modality_count() : 1) * block_, mrbm.hidden()),
      present_input_error_(Matrix::like(present_input_)),
      hidden_(mrbm.device(), steps_ * present_input_.rows(), mrbm.hidden()),
      hidden_errors_(Matrix::like(hidden_)),
      row_losses_(mrbm.device(), 1, mrbm.modality_count() * batch) {
  if (steps_ == 0) throw ConfigError("`mrbm.mean-field-steps` must be at least 1");
  if (tile_)
    make_stacks();
  else
    make_matrices();
}

/// Room for the stacks of multi_prediction.cl.
void MultiPrediction::make_stacks() {
  Device& device = mrbm_.device();
  codes_ = Matrix(device, 1, block_ * all_units(mrbm_));
  stacked_values_ = Matrix(device, 1, steps_ * codes_.columns());
  stacked_value_errors_ = Matrix::like(stacked_values_);
  // The biases' gradients stand behind the pieces.
  const std::size_t hidden = padded(mrbm_.hidden());
  const std::size_t biases = ceil_divide(all_units(mrbm_) + hidden, hidden);
  partial_ = Matrix(device, pieces() * all_units(mrbm_) + biases, mrbm_.hidden());
}

void MultiPrediction::make_matrices() {
  for (const Matrix& W : mrbm_.W) {
    target_.emplace_back(mrbm_.device(), block_, W.rows());
    values_.emplace_back(mrbm_.device(), (steps_ + 1) * block_, W.rows());
    value_errors_.emplace_back(mrbm_.device(), steps_ * block_, W.rows());
  }
  gradient_.emplace(mrbm_.parameters().in(optimizer_.gradients()), mrbm_.shape());
}

void MultiPrediction::learn(std::span<const Rows> visible, const LearningStep& step,
                            LossAccumulator& losses) {
  this->step({visible.begin(), visible.end()}, mrbm_update_rule(settings_, step.progress), losses);
}

void MultiPrediction::step(const std::vector<Rows>& codes, const UpdateRule& rule,
                           LossAccumulator& losses) {
  require(codes.size() == mrbm_.modality_count(), "multi-prediction: needs every modality");
  for (const Rows& rows : codes) {
    require(rows.index != nullptr, "multi-prediction: needs indexed codes");
    require(rows.count == batch_,
            "multi-prediction: the mini-batch has another size than it was made for");
  }
  optimizer_.next_step();
  if (tile_) {
    fused_step(codes, rule, losses);
    return;
  }
  optimizer_.gradients().set_zero();
  for (std::size_t m = 0; m < codes.size(); ++m) gather(codes[m], target_[m]);
  for (std::size_t m = codes.size(); m-- > 0;) back_propagate(m, losses);
  optimizer_.update(rule);
  mrbm_.refresh_transposed();
}

/// Forward, eq 32 and 33, block t of a stack being mean-field step t; block 0 of the values is
/// zero.
void MultiPrediction::unroll(std::size_t q) {
  const std::vector<std::size_t> present = all_but(q, mrbm_.modality_count());
  std::vector<Rows> units(target_.begin(), target_.end());
  present_input_of(mrbm_, present, units, present_input_);
  for (std::size_t t = 0; t < steps_; ++t) {
    const Rows hidden(hidden_, t * batch_, batch_);
    units[q] = Rows(values_[q], t * batch_, batch_);
    shared_units(mrbm_, std::span(&q, 1), units, present_input_, mean_of_units(VisibleKind::binary),
                 hidden);
    absent_units(mrbm_, q, hidden, mean_of_units(mrbm_.kind(q)),
                 Rows(values_[q], (t + 1) * batch_, batch_));
  }
}

void MultiPrediction::back_propagate(std::size_t q, LossAccumulator& losses) {
  const std::size_t n = batch_;
  const bool binary = mrbm_.kind(q) == VisibleKind::binary;
  const Matrix& W = mrbm_.W[q];
  const auto value = [&](std::size_t t) { return Rows(values_[q], t * n, n); };
  const auto hidden = [&](std::size_t t) { return Rows(hidden_, (t - 1) * n, n); };
  const auto value_error = [&](std::size_t t) { return Rows(value_errors_[q], (t - 1) * n, n); };
  const auto hidden_error = [&](std::size_t t) { return Rows(hidden_errors_, (t - 1) * n, n); };
  unroll(q);
  const float mean = 1.0F / static_cast<float>(n * W.rows());
  if (binary)
    losses.add_cross_entropy(q, target_[q], value(steps_), mean);
  else
    losses.add_squared_error(q, target_[q], value(steps_), 0.5F * mean);

  // The error before the units' activation is prediction − target, of either kind.
  scaled_difference(value(steps_), target_[q], 1.0F / static_cast<float>(n), value_error(steps_));
  for (std::size_t t = steps_; t >= 1; --t) {
    GemmOptions up, down;
    const Rows h = hidden(t), v = value(t - 1);
    up.activation = Activation::sigmoid_gradient;
    up.factor = &h;
    gemm(value_error(t), W, hidden_error(t), up);
    if (t == 1) break;
    if (binary) {
      down.activation = Activation::sigmoid_gradient;
      down.factor = &v;
    }
    gemm(hidden_error(t), mrbm_.W_transposed[q], value_error(t - 1), down);
  }
  block_sum(hidden_errors_, present_input_error_);
  add_gradients(q);
}

void MultiPrediction::add_gradients(std::size_t q) {
  const Rows before(values_[q], 0, steps_ * batch_);
  gemm_transposed_a(value_errors_[q], hidden_, gradient_->W[q], 1.0F, 1.0F);
  gemm_transposed_a(before, hidden_errors_, gradient_->W[q], 1.0F, 1.0F);
  for (const std::size_t p : all_but(q, mrbm_.modality_count()))
    gemm_transposed_a(target_[p], present_input_error_, gradient_->W[p], 1.0F, 1.0F);
  column_sum(value_errors_[q], 1.0F, 1.0F, gradient_->a[q]);
  column_sum(present_input_error_, 1.0F, 1.0F, gradient_->b);
}

MrbmParameters MultiPrediction::gradients() {
  return MrbmParameters::read(mrbm_.parameters().in(optimizer_.gradients()), mrbm_.shape());
}

}  // namespace mcdbn
