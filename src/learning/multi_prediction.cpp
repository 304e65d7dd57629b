#include "learning/multi_prediction.hpp"

#include <algorithm>

#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "learning/contrastive_divergence.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::optional<RowTile> choose_tile(const Mrbm& mrbm, std::size_t batch) {
  CrbmShape shape;
  shape.visible = std::max(mrbm.visible(Modality::track), mrbm.visible(Modality::pose));
  shape.hidden = mrbm.hidden();
  return choose_chain_tile(mrbm.device(), shape, batch);
}

}  // namespace

MultiPrediction::MultiPrediction(Mrbm& mrbm, std::size_t mean_field_steps, std::size_t batch)
    : MultiPrediction(mrbm, mean_field_steps, batch, choose_tile(mrbm, batch)) {}

MultiPrediction::MultiPrediction(Mrbm& mrbm, std::size_t mean_field_steps, std::size_t batch,
                                 std::optional<RowTile> tile)
    : mrbm_(mrbm),
      steps_(mean_field_steps),
      batch_(batch),
      tile_(tile),
      block_(whole_blocks(batch, tile)),
      drive_(mrbm.device(), (tile ? 2 : 1) * block_, mrbm.hidden()),
      drive_error_(Matrix::like(drive_)),
      hidden_(mrbm.device(), steps_ * drive_.rows(), mrbm.hidden()),
      hidden_errors_(Matrix::like(hidden_)),
      row_losses_(mrbm.device(), 1, 2 * block_),
      gradient_b_(Matrix::like(mrbm.b)),
      moments_b_{Matrix::like(mrbm.b), Matrix::like(mrbm.b)} {
  if (steps_ == 0) throw ConfigError("mrbm.mean-field-steps must be at least 1");
  for (std::size_t m = 0; m < 2; ++m) {
    const std::size_t visible = mrbm.W[m].rows();
    target_[m] = Matrix(mrbm.device(), block_, visible);
    values_[m] = Matrix(mrbm.device(), (steps_ + (tile ? 0 : 1)) * block_, visible);
    value_errors_[m] = Matrix(mrbm.device(), steps_ * block_, visible);
    gradient_W_[m] = Matrix::like(mrbm.W[m]);
    gradient_a_[m] = Matrix::like(mrbm.a[m]);
    moments_W_[m] = {Matrix::like(mrbm.W[m]), Matrix::like(mrbm.W[m])};
    moments_a_[m] = {Matrix::like(mrbm.a[m]), Matrix::like(mrbm.a[m])};
  }
}

void MultiPrediction::step(const Rows& track, const Rows& pose, const AdamRule& rule,
                           LossAccumulator& losses) {
  if (track.count != pose.count)
    throw ShapeError("multi-prediction: the modalities differ in rows");
  if (track.count != batch_)
    throw ShapeError("multi-prediction: the mini-batch has another size than it was made for");
  if (!track.index || !pose.index) throw ShapeError("multi-prediction: wants indexed codes");
  if (tile_) {
    fused_gradients(track, pose);
    fused_update(rule, losses);
    return;
  }
  gather(track, target_[index_of(Modality::track)]);
  gather(pose, target_[index_of(Modality::pose)]);
  back_propagate(Modality::track, track.count, false, losses);
  back_propagate(Modality::pose, track.count, true, losses);
  update(rule);
}

void MultiPrediction::back_propagate(Modality present, std::size_t n, bool add,
                                     LossAccumulator& losses) {
  const std::size_t p = index_of(present), q = index_of(other(present));
  const Matrix& W = mrbm_.W[q];
  const Matrix& Wt = mrbm_.W_transposed[q];
  // Block t of a stack: the values of mean-field step t.
  const auto value = [&](std::size_t t) { return Rows(values_[q], t * n, n); };
  const auto hidden = [&](std::size_t t) { return Rows(hidden_, (t - 1) * n, n); };
  const auto value_error = [&](std::size_t t) { return Rows(value_errors_[q], (t - 1) * n, n); };
  const auto hidden_error = [&](std::size_t t) { return Rows(hidden_errors_, (t - 1) * n, n); };

  // Forward, eq 32 and 33; block 0 of the values is zero.
  GemmOptions bias;
  bias.bias = &mrbm_.b;
  gemm(target_[p], mrbm_.W[p], drive_, bias);
  for (std::size_t t = 1; t <= steps_; ++t) {
    GemmOptions up, down;
    up.bias = &drive_;
    up.activation = Activation::sigmoid;
    gemm(value(t - 1), W, hidden(t), up);
    down.bias = &mrbm_.a[q];
    down.activation = Activation::sigmoid;
    gemm(hidden(t), Wt, value(t), down);
  }
  losses.add_cross_entropy(p, target_[q], value(steps_), 1.0F / static_cast<float>(n * W.rows()));

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
  gemm_transposed_a(value_errors_[q], hidden_, gradient_W_[q], 1.0F, beta);
  gemm_transposed_a(Rows(values_[q], 0, steps_ * n), hidden_errors_, gradient_W_[q], 1.0F, 1.0F);
  gemm_transposed_a(target_[p], drive_error_, gradient_W_[p], 1.0F, beta);
  column_sum(value_errors_[q], 1.0F, 0.0F, gradient_a_[q]);
  column_sum(drive_error_, 1.0F, beta, gradient_b_);
}

void MultiPrediction::update(const AdamRule& rule) {
  ++update_count_;
  AdamRule biases = rule;
  biases.weight_decay = 0.0F;
  for (std::size_t m = 0; m < 2; ++m) {
    adam_update(mrbm_.W[m], moments_W_[m].mean, moments_W_[m].square, gradient_W_[m], rule,
                update_count_);
    adam_update(mrbm_.a[m], moments_a_[m].mean, moments_a_[m].square, gradient_a_[m], biases,
                update_count_);
  }
  adam_update(mrbm_.b, moments_b_.mean, moments_b_.square, gradient_b_, biases, update_count_);
  mrbm_.refresh_transposed();
}

MrbmParameters MultiPrediction::gradients() const {
  return {{gradient_W_[0].to_host(), gradient_W_[1].to_host()},
          {gradient_a_[0].to_host(), gradient_a_[1].to_host()},
          gradient_b_.to_host()};
}

}  // namespace mcdbn
