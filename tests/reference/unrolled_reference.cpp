#include "reference/unrolled_reference.hpp"

#include <algorithm>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

Eigen::Index order_of(const Crbm& layer) {
  const Eigen::Index rows = std::max(layer.visible_history.rows(), layer.hidden_history.rows());
  return layer.weights.rows() > 0 ? rows / layer.weights.rows() : 0;
}

/// The `order` frames before `frame`, oldest first, side by side (eq 15).
RowVectorD history(const MatrixD& frames, Eigen::Index frame, Eigen::Index order) {
  RowVectorD row(order * frames.cols());
  for (Eigen::Index q = 0; q < order; ++q)
    row.segment(q * frames.cols(), frames.cols()) = frames.row(frame - order + q);
  return row;
}

RowVectorD dropped(const RowVectorD& units, const RowVectorD& factors) {
  if (factors.size() == 0) return units;
  return 0.5 + factors.array() * (units.array() - 0.5);
}

/// The factors of layer i, none if there are none at all.
RowVectorD factors_of(const std::vector<RowVectorD>& all, std::size_t i) {
  return i < all.size() ? all[i] : RowVectorD();
}

/// Hidden probabilities; rows before `first` stay zero.
MatrixD up(const Crbm& layer, const MatrixD& visible, Eigen::Index first,
           const RowVectorD& factors) {
  MatrixD hidden = MatrixD::Zero(visible.rows(), layer.weights.cols());
  for (Eigen::Index t = first; t < visible.rows(); ++t) {
    const MatrixD bias = dynamic_hidden_bias(layer, history(visible, t, order_of(layer)));
    hidden.row(t) = dropped(hidden_probability(layer, visible.row(t), bias), factors);
  }
  return hidden;
}

/// Eq 32 and 33 for one frame. @param present_input b and what the present modalities give
RowVectorD missing_code(const Mrbm& model, std::size_t q, const RowVectorD& present_input,
                        int steps, const RowVectorD& factors) {
  RowVectorD missing = RowVectorD::Zero(model.weights[q].rows());
  for (int step = 0; step < steps; ++step) {
    const RowVectorD hidden =
        dropped(sigmoid(MatrixD(present_input + missing * model.weights[q])), factors);
    missing = sigmoid(MatrixD(model.visible_bias[q] + hidden * model.weights[q].transpose()));
  }
  return missing;
}

MatrixD down(const Crbm& layer, const MatrixD& above, const RowVectorD& start, Eigen::Index first,
             const RowVectorD& factors) {
  MatrixD visible = start.replicate(above.rows(), 1);
  for (Eigen::Index t = first; t < above.rows(); ++t) {
    const MatrixD bias = dynamic_visible_bias(layer, history(visible, t, order_of(layer)));
    visible.row(t) = dropped(visible_mean(layer, above.row(t), bias), factors);
  }
  return visible;
}

}  // namespace

Eigen::VectorXd UnrolledModel::flattened() const {
  std::vector<Eigen::VectorXd> parts;
  for (const auto& stack : stacks)
    for (const Crbm& layer : stack) parts.push_back(layer.flattened());
  parts.push_back(mrbm.flattened());
  Eigen::Index size = 0;
  for (const auto& part : parts) size += part.size();
  Eigen::VectorXd flat(size);
  Eigen::Index at = 0;
  for (const auto& part : parts) {
    flat.segment(at, part.size()) = part;
    at += part.size();
  }
  return flat;
}

UnrolledModel UnrolledModel::with_parameters(const Eigen::VectorXd& flat) const {
  UnrolledModel result = *this;
  Eigen::Index at = 0;
  const auto take = [&](auto& part) {
    const Eigen::Index size = part.flattened().size();
    part = part.with_parameters(flat.segment(at, size));
    at += size;
  };
  for (auto& stack : result.stacks)
    for (Crbm& layer : stack) take(layer);
  take(result.mrbm);
  return result;
}

MatrixD joint_prediction(const UnrolledModel& model, std::size_t q,
                         const std::vector<MatrixD>& values, int first, int mean_field_steps,
                         const DropOut& drop_out) {
  MatrixD present_input;
  std::size_t number = 0;
  for (std::size_t p = 0; p < values.size(); ++p) {
    if (p == q) continue;
    MatrixD code = values[p];
    Eigen::Index valid = 0;
    for (const Crbm& layer : model.stacks[p]) {
      valid += order_of(layer);
      code = up(layer, code, valid, factors_of(drop_out.up, number++));
    }
    if (present_input.size() == 0) present_input = model.mrbm.hidden_bias.replicate(code.rows(), 1);
    present_input += code * model.mrbm.weights[p];
  }
  MatrixD state(present_input.rows(), model.mrbm.weights[q].rows());
  for (Eigen::Index t = 0; t < present_input.rows(); ++t)
    state.row(t) =
        missing_code(model.mrbm, q, present_input.row(t), mean_field_steps, drop_out.shared);
  for (std::size_t i = model.stacks[q].size(); i-- > 0;)
    state = down(model.stacks[q][i], state, model.start[q][i], first, factors_of(drop_out.down, i));
  return state;
}

MatrixD joint_prediction(const UnrolledModel& model, int present, const MatrixD& values, int first,
                         int mean_field_steps, const DropOut& drop_out) {
  return joint_prediction(model, static_cast<std::size_t>(1 - present),
                          std::vector<MatrixD>{values, values}, first, mean_field_steps, drop_out);
}

}  // namespace mcdbn::reference
