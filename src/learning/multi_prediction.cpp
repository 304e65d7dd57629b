#include "learning/multi_prediction.hpp"

#include <algorithm>

#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "learning/contrastive_divergence.hpp"
#include "machines/mean_field.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::optional<RowTile> choose_tile(const Mrbm& mrbm, std::size_t batch) {
  CrbmShape shape;
  shape.visible = std::max(mrbm.visible(Modality::track), mrbm.visible(Modality::pose));
  shape.hidden = mrbm.hidden();
  return choose_chain_tile(mrbm.device(), shape, batch);
}

/// Flat, then falling, so that the last epochs average out the noise.
double falling_rate(double rate, double progress) {
  constexpr double kFlat = 0.5, kEnd = 0.02;
  return progress < kFlat ? rate : rate * (1.0 - (1.0 - kEnd) * (progress - kFlat) / (1.0 - kFlat));
}

}  // namespace

MultiPrediction::MultiPrediction(Mrbm& mrbm, std::size_t batch,
                                 const MultiPredictionSettings& settings, OptimizerKind optimizer)
    : MultiPrediction(mrbm, batch, settings, choose_tile(mrbm, batch), optimizer) {}

MultiPrediction::MultiPrediction(Mrbm& mrbm, std::size_t batch,
                                 const MultiPredictionSettings& settings,
                                 std::optional<RowTile> tile, OptimizerKind optimizer)
    : mrbm_(mrbm),
      settings_(settings),
      steps_(settings.mean_field_steps),
      batch_(batch),
      tile_(tile),
      block_(whole_blocks(batch, tile)),
      optimizer_(mrbm.parameters(), optimizer),
      drive_(mrbm.device(), (tile ? 2 : 1) * block_, mrbm.hidden()),
      drive_error_(Matrix::like(drive_)),
      hidden_(mrbm.device(), steps_ * drive_.rows(), mrbm.hidden()),
      hidden_errors_(Matrix::like(hidden_)),
      row_losses_(mrbm.device(), 1, 2 * block_) {
  if (steps_ == 0) throw ConfigError("`mrbm.mean-field-steps` must be at least 1");
  if (tile_)
    make_stacks();
  else
    make_matrices();
}

/// Room for the stacks of multi_prediction.cl.
void MultiPrediction::make_stacks() {
  Device& device = mrbm_.device();
  codes_ = Matrix(device, 1, block_ * all_units());
  stacked_values_ = Matrix(device, 1, steps_ * codes_.columns());
  stacked_value_errors_ = Matrix::like(stacked_values_);
}

void MultiPrediction::make_matrices() {
  for (std::size_t m = 0; m < 2; ++m) {
    const std::size_t visible = mrbm_.W[m].rows();
    target_[m] = Matrix(mrbm_.device(), block_, visible);
    values_[m] = Matrix(mrbm_.device(), (steps_ + 1) * block_, visible);
    value_errors_[m] = Matrix(mrbm_.device(), steps_ * block_, visible);
  }
  gradient_.emplace(mrbm_.parameters().in(optimizer_.gradients()));
}

void MultiPrediction::learn(std::span<const Rows> visible, const LearningStep& step,
                            LossAccumulator& losses) {
  require(visible.size() == 2, "multi-prediction: wants two sequences");
  const UpdateRule rule =
      UpdateRule::adam(static_cast<float>(falling_rate(settings_.rate, step.progress)),
                       static_cast<float>(settings_.weight_decay));
  this->step(visible[0], visible[1], rule, losses);
}

void MultiPrediction::step(const Rows& track, const Rows& pose, const UpdateRule& rule,
                           LossAccumulator& losses) {
  if (track.count != pose.count)
    throw ShapeError("multi-prediction: the modalities differ in rows");
  if (track.count != batch_)
    throw ShapeError("multi-prediction: the mini-batch has another size than it was made for");
  if (!track.index || !pose.index) throw ShapeError("multi-prediction: wants indexed codes");
  optimizer_.next_step();
  if (tile_) {
    gather_two(track, pose, codes_, block_ * padded(track.columns));
    fused_chain();
    fused_update(rule, losses);
    return;
  }
  gather(track, target_[index_of(Modality::track)]);
  gather(pose, target_[index_of(Modality::pose)]);
  back_propagate(Modality::track, false, losses);
  back_propagate(Modality::pose, true, losses);
  optimizer_.update(rule);
  mrbm_.refresh_transposed();
}

void MultiPrediction::back_propagate(Modality present, bool add, LossAccumulator& losses) {
  const std::size_t n = batch_;
  const std::size_t p = index_of(present), q = index_of(other(present));
  const Matrix& W = mrbm_.W[q];
  const Matrix& Wt = mrbm_.W_transposed[q];
  // Block t of a stack: the values of mean-field step t.
  const auto value = [&](std::size_t t) { return Rows(values_[q], t * n, n); };
  const auto hidden = [&](std::size_t t) { return Rows(hidden_, (t - 1) * n, n); };
  const auto value_error = [&](std::size_t t) { return Rows(value_errors_[q], (t - 1) * n, n); };
  const auto hidden_error = [&](std::size_t t) { return Rows(hidden_errors_, (t - 1) * n, n); };

  // Forward, eq 32 and 33; block 0 of the values is zero.
  GemmOptions probabilities;
  probabilities.activation = Activation::sigmoid;
  drive_of(mrbm_, p, target_[p], drive_);
  for (std::size_t t = 1; t <= steps_; ++t) {
    shared_units(mrbm_, q, value(t - 1), drive_, probabilities, hidden(t));
    absent_units(mrbm_, q, hidden(t), probabilities, value(t));
  }
  losses.add_cross_entropy(q, target_[q], value(steps_), 1.0F / static_cast<float>(n * W.rows()));

  // Backward: the cross-entropy's error before the sigmoid is prediction − target.
  scaled_difference(value(steps_), target_[q], 1.0F / static_cast<float>(n), value_error(steps_));
  for (std::size_t t = steps_; t >= 1; --t) {
    GemmOptions up, down;
    const Rows h = hidden(t), v = value(t - 1);
    up.activation = Activation::sigmoid_gradient;
    up.factor = &h;
    gemm(value_error(t), W, hidden_error(t), up);
    if (t == 1) break;
    down.activation = Activation::sigmoid_gradient;
    down.factor = &v;
    gemm(hidden_error(t), Wt, value_error(t - 1), down);
  }
  block_sum(hidden_errors_, drive_error_);

  const float beta = add ? 1.0F : 0.0F;
  gemm_transposed_a(value_errors_[q], hidden_, gradient_->W[q], 1.0F, beta);
  gemm_transposed_a(Rows(values_[q], 0, steps_ * n), hidden_errors_, gradient_->W[q], 1.0F, 1.0F);
  gemm_transposed_a(target_[p], drive_error_, gradient_->W[p], 1.0F, beta);
  column_sum(value_errors_[q], 1.0F, 0.0F, gradient_->a[q]);
  column_sum(drive_error_, 1.0F, beta, gradient_->b);
}

MrbmParameters MultiPrediction::gradients() {
  return MrbmParameters::read(mrbm_.parameters().in(optimizer_.gradients()));
}

}  // namespace mcdbn
