#include "reference/joint_reference.hpp"

#include <numeric>

namespace mcdbn::reference {
namespace {

Eigen::Index order_of(const Crbm& layer) {
  return layer.weights.rows() > 0 ? layer.hidden_history.rows() / layer.weights.rows() : 0;
}

/// The `order` frames before `frame`, oldest first, side by side (eq 15).
RowVectorD history(const MatrixD& frames, Eigen::Index frame, Eigen::Index order) {
  RowVectorD row(order * frames.cols());
  for (Eigen::Index q = 0; q < order; ++q)
    row.segment(q * frames.cols(), frames.cols()) = frames.row(frame - order + q);
  return row;
}

/// Hidden probabilities; rows before `first` stay zero.
MatrixD up(const Crbm& layer, const MatrixD& visible, Eigen::Index first) {
  MatrixD hidden = MatrixD::Zero(visible.rows(), layer.weights.cols());
  for (Eigen::Index t = first; t < visible.rows(); ++t) {
    const MatrixD bias = dynamic_hidden_bias(layer, history(visible, t, order_of(layer)));
    hidden.row(t) = hidden_probability(layer, visible.row(t), bias);
  }
  return hidden;
}

MatrixD down(const Crbm& layer, const MatrixD& above, const RowVectorD& start, Eigen::Index first) {
  MatrixD visible = start.replicate(above.rows(), 1);
  for (Eigen::Index t = first; t < above.rows(); ++t) {
    const MatrixD bias = dynamic_visible_bias(layer, history(visible, t, order_of(layer)));
    visible.row(t) = visible_mean(layer, above.row(t), bias);
  }
  return visible;
}

}  // namespace

Eigen::VectorXd JointModel::flattened() const {
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

JointModel JointModel::with_parameters(const Eigen::VectorXd& flat) const {
  JointModel result = *this;
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

MatrixD joint_prediction(const JointModel& model, int present, const MatrixD& values, int first,
                         int mean_field_steps) {
  const auto p = static_cast<std::size_t>(present), q = 1 - p;
  MatrixD code = values;
  Eigen::Index valid = 0;
  for (const Crbm& layer : model.stacks[p]) {
    valid += order_of(layer);
    code = up(layer, code, valid);
  }
  MatrixD state = mean_field(model.mrbm, present, code, {mean_field_steps, false}).missing.back();
  for (std::size_t i = model.stacks[q].size(); i-- > 0;)
    state = down(model.stacks[q][i], state, model.start[q][i], first);
  return state;
}

}  // namespace mcdbn::reference
