#include "learning/unrolled_pass.hpp"

#include <algorithm>

#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "machines/mean_field.hpp"
#include "machines/own_units.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::size_t longest_order(const std::deque<UnrolledNetwork::Layer>& layers) {
  std::size_t order = 0;
  for (const auto& layer : layers) order = std::max(order, layer.crbm.shape().order);
  return order;
}

std::size_t total_order(const std::deque<UnrolledNetwork::Layer>& layers) {
  std::size_t order = 0;
  for (const auto& layer : layers) order += layer.crbm.shape().order;
  return order;
}

/// `count` rows from `first` on, each with the `order` frames that follow it.
Rows following(const Matrix& errors, std::size_t first, std::size_t count, std::size_t step,
               std::size_t order) {
  Rows rows = Rows::strided(errors, first + 1, count, step, order);
  rows.columns = order * errors.stride();
  return rows;
}

GemmOptions added() {
  GemmOptions options;
  options.beta = 1.0F;
  return options;
}

/// Rows of the windows' frames from `first` on, among those of all frames.
IndexBuffer coded_index(Device& device, const SequenceWindows& windows) {
  std::vector<std::int32_t> rows;
  for (std::size_t window = 0; window < windows.count; ++window)
    for (std::size_t frame = windows.first; frame < windows.frames; ++frame)
      rows.push_back(static_cast<std::int32_t>(window * windows.frames + frame));
  return {device, rows};
}

/// Activation of a layer's visible units, in the form of unrolled_network.hpp.
Activation visible_activation(VisibleKind kind, bool is_lowest) {
  if (kind == VisibleKind::gaussian) return Activation::none;
  return is_lowest ? Activation::sigmoid : Activation::centered_sigmoid;
}

GemmOptions through_units(const Rows* units, float kept_share = 1.0F) {
  GemmOptions options;
  options.activation = Activation::centered_sigmoid_gradient;
  options.factor = units;
  options.kept_share = kept_share;
  return options;
}

/// Back-propagation through a layer's visible units. @param units of the layer whose error it is
GemmOptions through_visible(VisibleKind kind, bool is_lowest, const Rows* units, float kept_share) {
  if (!is_lowest) return through_units(units, kept_share);
  GemmOptions options;
  if (kind == VisibleKind::gaussian) return options;
  options.activation = Activation::sigmoid_gradient;
  options.factor = units;
  return options;
}

}  // namespace

UnrolledPass::UnrolledPass(UnrolledNetwork& network, std::size_t absent,
                           const SequenceWindows& windows, bool fused)
    : network_(network),
      absent_(absent),
      windows_(windows),
      rows_(windows.rows()),
      steps_(network.mean_field_steps()),
      coded_frames_(windows.frames - windows.first),
      code_rows_(windows.count * coded_frames_),
      coded_index_(coded_index(network.device(), windows)),
      down_layers_(network.layers(absent)) {
  std::size_t least = longest_order(down_layers_);
  for (std::size_t m = 0; m < network.modality_count(); ++m) {
    if (m == absent) continue;
    least = std::max(least, total_order(network.layers(m)));
    up_.push_back(make_up_pass(m));
  }
  if (windows.first < least || windows.judged_from < windows.first ||
      windows.judged_from >= windows.frames)
    throw ShapeError("unrolled pass: the windows are too short for the layers' histories");
  Device& device = network.device();
  const std::size_t absent_code = down_layers_.back().crbm.shape().hidden,
                    shared = network.mrbm().hidden();
  // The mean field starts from zeros, which are −½ about zero.
  start_ = Matrix::from_host(device,
                             MatrixF::Constant(1, static_cast<Eigen::Index>(absent_code), -0.5F));
  start_input_ = Matrix(device, 1, shared);
  start_error_ = Matrix(device, 1, shared);
  present_input_ = Matrix(device, code_rows_, shared);
  present_input_error_ = Matrix(device, code_rows_, shared);
  values_ = Matrix(device, steps_ * code_rows_, absent_code);
  value_errors_ = Matrix(device, steps_ * code_rows_, absent_code);
  hidden_ = Matrix(device, steps_ * code_rows_, shared);
  hidden_errors_ = Matrix(device, steps_ * code_rows_, shared);
  for (const auto& layer : down_layers_) {
    states_.push_back(
        Matrix::filled_with_row(in_own_units(layer.crbm, layer.crbm.visible_mean), rows_));
    state_errors_.emplace_back(device, rows_ + layer.crbm.shape().order,
                               layer.crbm.shape().visible);
    down_errors_.emplace_back(device, code_rows_, layer.crbm.shape().visible);
    const InputKind input_kind =
        &layer == &down_layers_.front() ? InputKind::data : InputKind::code;
    fused_.push_back(fused ? FusedDownPass::of(layer, input_kind, windows) : std::nullopt);
    down_inputs_.push_back(fused_.back() ? Matrix(device, code_rows_, layer.crbm.shape().visible)
                                         : Matrix());
  }
  if (down_layers_.front().crbm.has_deviation) prediction_ = Matrix::like(states_.front());
}

UnrolledPass::UpPass UnrolledPass::make_up_pass(std::size_t modality) {
  Device& device = network_.device();
  Layers& layers = network_.layers(modality);
  UpPass up{modality, layers, Matrix(device, rows_, layers.front().crbm.shape().visible),
            {},       {},     {}};
  const std::size_t code = layers.back().crbm.shape().hidden;
  for (const auto& layer : layers) {
    const bool is_last = &layer == &layers.back();
    const std::size_t hidden = layer.crbm.shape().hidden;
    up.units.emplace_back(device, is_last ? code_rows_ : rows_, hidden);
    // Rows past the end stay zero, as do those before `first`: no error comes from behind a window.
    up.errors.push_back(layers.size() > 1 ? Matrix(device, rows_ + layer.crbm.shape().order, hidden)
                                          : Matrix());
  }
  up.code_error = Matrix(device, code_rows_, code);
  if (code != network_.mrbm().visible(modality))
    throw ShapeError("unrolled pass: the MRBM does not fit the CDBN's code");
  return up;
}

void UnrolledPass::forward(std::span<const Rows> modalities, float kept_share,
                           const RandomKey& key) {
  kept_share_ = kept_share;
  drop_out_key_ = key;
  for (UpPass& up : up_) {
    gather(modalities[up.modality], up.input);
    const Crbm& lowest = up.layers.front().crbm;
    if (lowest.has_deviation) scale_columns(up.input, lowest.visible_deviation, true);
    up_pass(up);
  }
  mean_field();
  down_pass();
  if (prediction_.empty()) return;
  prediction_.copy_from(states_.front());
  to_data_units(down_layers_.front().crbm, prediction_);
}

void UnrolledPass::drop_out(const Rows& units, std::size_t alike) {
  if (kept_share_ < 1.0F) dropout(units, kept_share_, drop_out_key_, alike);
}

void UnrolledPass::up_pass(UpPass& up) {
  const Matrix* below = &up.input;
  for (std::size_t i = 0; i < up.layers.size(); ++i) {
    const Crbm& layer = up.layers[i].crbm;
    const bool is_last = i + 1 == up.layers.size();
    const std::size_t order = layer.shape().order;
    ++drop_out_key_.phase;
    const Rows units = is_last ? Rows(up.units[i]) : from(up.units[i], order);
    const Rows frames = is_last ? coded(*below) : from(*below, order);
    GemmOptions options;
    options.bias = &layer.b;
    const bool has_history = layer.shape().order_B() > 0;
    options.activation = has_history ? Activation::none : Activation::centered_sigmoid;
    gemm(frames, layer.W, units, options);
    if (has_history) {
      options = added();
      options.activation = Activation::centered_sigmoid;
      gemm(layer.history_for_B(frames), layer.B, units, options);
    }
    drop_out(up.units[i], is_last ? coded_frames_ : windows_.frames);
    below = &up.units[i];
  }
}

void UnrolledPass::mean_field() {
  const Mrbm& mrbm = network_.mrbm();
  const std::size_t q = absent_;
  std::vector<std::size_t> present;
  std::vector<Rows> units(network_.modality_count(), Rows(values_));
  for (const UpPass& up : up_) {
    present.push_back(up.modality);
    units[up.modality] = up.units.back();
  }
  GemmOptions centered;
  centered.activation = Activation::centered_sigmoid;
  present_input_of(mrbm, present, units, present_input_);
  ++drop_out_key_.phase;
  for (std::size_t t = 1; t <= steps_; ++t) {
    const Rows hidden = step_of(hidden_, t);
    if (t == 1) {
      shared_from_start(hidden);
    } else {
      units[q] = step_of(values_, t - 1);
      shared_units(mrbm, std::span(&q, 1), units, present_input_, centered, hidden);
    }
    drop_out(hidden, coded_frames_);  // the same units in every step
    absent_units(mrbm, q, hidden, centered, step_of(values_, t));
  }
}

/// The absent units start alike in every row, and so does what they give.
void UnrolledPass::shared_from_start(const Rows& hidden) {
  gemm(start_, network_.mrbm().W[absent_], start_input_);
  hidden_.copy_rows_from(present_input_, 0, code_rows_, hidden.first);
  GemmOptions options;
  options.bias = &start_input_;
  options.activation = Activation::centered_sigmoid;
  apply_epilogue(hidden, options);
}

void UnrolledPass::down_pass() {
  for (std::size_t i = down_layers_.size(); i-- > 0;) {
    ++drop_out_key_.phase;
    // Drop-out comes between the frames of what is not the lowest layer.
    if (!fused_[i] || (i > 0 && kept_share_ < 1.0F)) {
      down_pass_by_frames(i);
      continue;
    }
    const Crbm& layer = down_layers_[i].crbm;
    const bool is_top = i + 1 == down_layers_.size();
    GemmOptions options;
    options.bias = &layer.a;
    gemm(is_top ? step_of(values_, steps_) : coded(states_[i + 1]), layer.W_transposed,
         down_inputs_[i], options);
    fused_[i]->forward(down_inputs_[i], states_[i]);
  }
}

void UnrolledPass::down_pass_by_frames(std::size_t i) {
  const Crbm& layer = down_layers_[i].crbm;
  const bool is_top = i + 1 == down_layers_.size();
  const Activation activation = visible_activation(layer.shape().kind, i == 0);
  const std::size_t order = layer.shape().order_A();
  for (std::size_t frame = windows_.first; frame < windows_.frames; ++frame) {
    const Rows state = at(states_[i], frame);
    const Rows above =
        is_top ? Rows::strided(values_, (steps_ - 1) * code_rows_ + frame - windows_.first,
                               windows_.count, coded_frames_)
               : at(states_[i + 1], frame);
    GemmOptions options;
    options.bias = &layer.a;
    if (order == 0) options.activation = activation;
    gemm(above, layer.W_transposed, state, options);
    if (order > 0) {
      options = added();
      options.activation = activation;
      gemm(layer.history_for_A(state), layer.A, state, options);
    }
    if (i > 0) drop_out(state, 1);  // the same units in every frame
  }
}

void UnrolledPass::backward() {
  // The prediction is the deviation times the units, and so is the derivative by the units.
  to_data_units(down_layers_.front().crbm, prediction_error());
  down_pass_backward();
  mean_field_backward();
  for (UpPass& up : up_) up_pass_backward(up);
}

void UnrolledPass::down_pass_backward() {
  for (std::size_t i = 0; i < down_layers_.size(); ++i) {
    if (fused_[i])
      fused_[i]->backward(states_[i], state_errors_[i], kept_share_);
    else
      down_backward_by_frames(i);
    add_down_gradients(i);
  }
}

/// Through time: what a frame did to those that had it as history.
void UnrolledPass::down_backward_by_frames(std::size_t i) {
  UnrolledNetwork::Layer& layer = down_layers_[i];
  const std::size_t order = layer.crbm.shape().order_A();
  for (std::size_t frame = windows_.frames; frame-- > windows_.first;) {
    const Rows state = at(states_[i], frame), error = at(state_errors_[i], frame);
    GemmOptions options = through_visible(layer.crbm.shape().kind, i == 0, &state, kept_share_);
    options.beta = 1.0F;
    if (order > 0)
      gemm(following(state_errors_[i], frame, windows_.count, windows_.frames, order),
           layer.A_following, error, options);
    else if (options.activation != Activation::none)
      apply_epilogue(error, options);
  }
}

void UnrolledPass::add_down_gradients(std::size_t i) {
  UnrolledNetwork::Layer& layer = down_layers_[i];
  const CrbmShape& shape = layer.crbm.shape();
  const bool is_top = i + 1 == down_layers_.size();
  gather(coded(state_errors_[i]), down_errors_[i]);
  const Rows error(down_errors_[i]);
  if (is_top) {
    const Rows code = step_of(values_, steps_);
    gemm_transposed_a(error, code, layer.gradient.W, 1.0F, 1.0F);
    gemm(error, layer.crbm.W, step_of(value_errors_, steps_), through_units(&code));
  } else {
    const std::size_t first = windows_.first;
    const Rows all_errors(state_errors_[i], first, rows_ - first);
    gemm_transposed_a(all_errors, from(states_[i + 1], first), layer.gradient.W, 1.0F, 1.0F);
    gemm(all_errors, layer.crbm.W, Rows(state_errors_[i + 1], first, rows_ - first));
  }
  if (shape.order_A() > 0)
    gemm_transposed_a(layer.crbm.history_for_A(coded(states_[i])), error, layer.gradient.A, 1.0F,
                      1.0F);
  column_sum(error, 1.0F, 1.0F, layer.gradient.a);
}

void UnrolledPass::mean_field_backward() {
  Mrbm& mrbm = network_.mrbm();
  const std::size_t q = absent_;
  for (std::size_t t = steps_; t >= 1; --t) {
    const Rows h = step_of(hidden_, t), hidden_error = step_of(hidden_errors_, t);
    gemm(step_of(value_errors_, t), mrbm.W[q], hidden_error, through_units(&h, kept_share_));
    if (t == 1) break;
    const Rows v = step_of(values_, t - 1);
    gemm(hidden_error, mrbm.W_transposed[q], step_of(value_errors_, t - 1), through_units(&v));
  }
  block_sum(hidden_errors_, present_input_error_);
  add_mean_field_gradients();
  for (UpPass& up : up_) {
    const Rows code(up.units.back());
    gemm(present_input_error_, mrbm.W_transposed[up.modality], up.code_error,
         through_units(&code, kept_share_));
  }
}

void UnrolledPass::add_mean_field_gradients() {
  MrbmMatrices& gradient = network_.mrbm_gradient();
  const std::size_t q = absent_, later = (steps_ - 1) * code_rows_;
  gemm_transposed_a(value_errors_, hidden_, gradient.W[q], 1.0F, 1.0F);
  if (later > 0)
    gemm_transposed_a(Rows(values_, 0, later), Rows(hidden_errors_, code_rows_, later),
                      gradient.W[q], 1.0F, 1.0F);
  column_sum(step_of(hidden_errors_, 1), 1.0F, 0.0F, start_error_);
  gemm_transposed_a(start_, start_error_, gradient.W[q], 1.0F, 1.0F);
  column_sum(value_errors_, 1.0F, 1.0F, gradient.a[q]);
  column_sum(present_input_error_, 1.0F, 1.0F, gradient.b);
  for (const UpPass& up : up_)
    gemm_transposed_a(up.units.back(), present_input_error_, gradient.W[up.modality], 1.0F, 1.0F);
}

void UnrolledPass::up_pass_backward(UpPass& up) {
  for (std::size_t i = up.layers.size(); i-- > 0;) {
    UnrolledNetwork::Layer& layer = up.layers[i];
    const std::size_t order = layer.crbm.shape().order, order_B = layer.crbm.shape().order_B();
    const bool is_last = i + 1 == up.layers.size();
    const Matrix& below = i > 0 ? up.units[i - 1] : up.input;
    const Rows error = is_last ? Rows(up.code_error) : Rows(up.errors[i], order, rows_ - order);
    const Rows frames = is_last ? coded(below) : from(below, order);
    gemm_transposed_a(frames, error, layer.gradient.W, 1.0F, 1.0F);
    if (order_B > 0)
      gemm_transposed_a(layer.crbm.history_for_B(frames), error, layer.gradient.B, 1.0F, 1.0F);
    column_sum(error, 1.0F, 1.0F, layer.gradient.b);
    if (i == 0) break;
    if (is_last) scatter(up.code_error, coded(up.errors[i]));
    const Rows units(below), error_below(up.errors[i - 1], 0, rows_);
    GemmOptions options = through_units(&units, kept_share_);
    if (order_B == 0) {
      gemm(Rows(up.errors[i], 0, rows_), layer.crbm.W_transposed, error_below, options);
      continue;
    }
    gemm(Rows(up.errors[i], 0, rows_), layer.crbm.W_transposed, error_below);
    options.beta = 1.0F;
    gemm(following(up.errors[i], 0, rows_, 1, order_B), layer.B_following, error_below, options);
  }
}

}  // namespace mcdbn
