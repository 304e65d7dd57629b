#include "reference/unrolled_gradient.hpp"

#include <algorithm>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

Eigen::Index order_A(const Crbm& layer) {
  return layer.visible_history.rows() / layer.weights.rows();
}
Eigen::Index order_B(const Crbm& layer) {
  return layer.hidden_history.rows() / layer.weights.rows();
}
Eigen::Index order_of(const Crbm& layer) {
  return std::max(order_A(layer), order_B(layer));
}

/// The `order` frames before `frame`, oldest first, side by side.
RowVectorD history(const MatrixD& frames, Eigen::Index frame, Eigen::Index order) {
  return frames.middleRows(frame - order, order).reshaped<Eigen::RowMajor>().transpose();
}

bool is_binary(const Crbm& layer) {
  return layer.visible_units == VisibleUnits::binary;
}

/// Biases and starts when the units' zero moves by `by`.
UnrolledModel moved(UnrolledModel model, double by) {
  for (std::size_t m = 0; m < 2; ++m) {
    for (std::size_t i = 0; i < model.stacks[m].size(); ++i) {
      Crbm& layer = model.stacks[m][i];
      const double visible = i > 0 ? by : 0.0;
      layer.hidden_bias += visible * (layer.weights.colwise().sum());
      layer.hidden_bias += visible * (layer.hidden_history.colwise().sum());
      layer.visible_bias += by * layer.weights.rowwise().sum().transpose();
      layer.visible_bias += visible * layer.visible_history.colwise().sum();
      model.start[m][i].array() -= visible;
    }
    model.mrbm.hidden_bias += by * model.mrbm.weights[m].colwise().sum();
    model.mrbm.visible_bias[m] += by * model.mrbm.weights[m].rowwise().sum().transpose();
  }
  return model;
}

RowVectorD centered_sigmoid(const RowVectorD& input) {
  return sigmoid(MatrixD(input)).array() - 0.5;
}

RowVectorD factors_of(const std::vector<RowVectorD>& all, std::size_t i) {
  return i < all.size() ? all[i] : RowVectorD();
}

}  // namespace

UnrolledModel centered(const UnrolledModel& model) {
  return moved(model, 0.5);
}
UnrolledModel uncentered(const UnrolledModel& model) {
  return moved(model, -0.5);
}

UnrolledGradient::UnrolledGradient(const UnrolledModel& centered_model, int present,
                                   const MatrixD& values, int first, int mean_field_steps,
                                   const DropOut& drop_out)
    : model_(centered_model),
      p_(static_cast<std::size_t>(present)),
      q_(1 - p_),
      frames_(values.rows()),
      first_(first),
      values_(values) {
  const auto units = [&](Eigen::Index width, RowVectorD factors) {
    const MatrixD zeros = MatrixD::Zero(frames_, width);
    return Units{zeros, zeros, std::move(factors)};
  };
  for (std::size_t i = 0; i < model_.stacks[p_].size(); ++i)
    up_.push_back(units(model_.stacks[p_][i].hidden_bias.size(), factors_of(drop_out.up, i)));
  for (int step = 0; step < mean_field_steps; ++step)
    shared_.push_back(units(model_.mrbm.hidden_bias.size(), drop_out.shared));
  for (int step = 0; step <= mean_field_steps; ++step)
    missing_.push_back(units(model_.mrbm.visible_bias[q_].size(), {}));
  for (std::size_t i = 0; i < model_.stacks[q_].size(); ++i)
    down_.push_back(units(model_.stacks[q_][i].visible_bias.size(), factors_of(drop_out.down, i)));
  go_up();
  infer(mean_field_steps);
  go_down();
}

void UnrolledGradient::drop(Units& units, Eigen::Index row) {
  units.dropped.row(row) = units.own.row(row);
  if (units.factors.size() > 0) units.dropped.row(row).array() *= units.factors.array();
}

RowVectorD UnrolledGradient::through(const Units& units, Eigen::Index row,
                                     const RowVectorD& error) {
  RowVectorD result = error.array() * (0.25 - units.own.row(row).array().square());
  if (units.factors.size() > 0) result.array() *= units.factors.array();
  return result;
}

RowVectorD UnrolledGradient::through_data(const Units& units, Eigen::Index row,
                                          const RowVectorD& error) {
  const auto p = units.own.row(row).array();
  return error.array() * p * (1.0 - p);
}

void UnrolledGradient::go_up() {
  const MatrixD* below = &values_;
  Eigen::Index valid = 0;
  for (std::size_t i = 0; i < up_.size(); ++i) {
    const Crbm& layer = model_.stacks[p_][i];
    valid += order_of(layer);
    for (Eigen::Index t = valid; t < frames_; ++t) {
      up_[i].own.row(t) =
          centered_sigmoid(layer.hidden_bias + below->row(t) * layer.weights +
                           history(*below, t, order_B(layer)) * layer.hidden_history);
      drop(up_[i], t);
    }
    below = &up_[i].dropped;
  }
}

void UnrolledGradient::infer(int steps) {
  const Mrbm& mrbm = model_.mrbm;
  missing_[0].own.setConstant(-0.5);  // zero, about one half
  missing_[0].dropped = missing_[0].own;
  for (int s = 0; s < steps; ++s)
    for (Eigen::Index t = first_; t < frames_; ++t) {
      shared_[s].own.row(t) =
          centered_sigmoid(mrbm.hidden_bias + up_.back().dropped.row(t) * mrbm.weights[p_] +
                           missing_[s].own.row(t) * mrbm.weights[q_]);
      drop(shared_[s], t);
      missing_[s + 1].own.row(t) = centered_sigmoid(
          mrbm.visible_bias[q_] + shared_[s].dropped.row(t) * mrbm.weights[q_].transpose());
      drop(missing_[s + 1], t);
    }
}

void UnrolledGradient::go_down() {
  const MatrixD* above = &missing_.back().own;
  for (std::size_t i = down_.size(); i-- > 0;) {
    const Crbm& layer = model_.stacks[q_][i];
    Units& units = down_[i];
    units.own = model_.start[q_][i].replicate(frames_, 1);
    units.dropped = units.own;
    for (Eigen::Index t = first_; t < frames_; ++t) {
      const RowVectorD input = layer.visible_bias + above->row(t) * layer.weights.transpose() +
                               history(units.dropped, t, order_A(layer)) * layer.visible_history;
      units.own.row(t) = i > 0              ? centered_sigmoid(input)
                         : is_binary(layer) ? RowVectorD(sigmoid(MatrixD(input)))
                                            : input;
      drop(units, t);
    }
    above = &units.dropped;
  }
}

void UnrolledGradient::add_to(UnrolledModel& sum, const MatrixD& error) const {
  back_up(sum, back_through_mean_field(sum, back_down(sum, error)));
}

MatrixD UnrolledGradient::back_down(UnrolledModel& sum, MatrixD error) const {
  for (std::size_t i = 0; i < down_.size(); ++i) {
    const Crbm& layer = model_.stacks[q_][i];
    Crbm& gradient = sum.stacks[q_][i];
    const MatrixD& above = i + 1 < down_.size() ? down_[i + 1].dropped : missing_.back().own;
    const Eigen::Index order = order_A(layer), width = layer.visible_bias.size();
    MatrixD error_above = MatrixD::Zero(frames_, above.cols());
    for (Eigen::Index t = frames_; t-- > first_;) {
      const RowVectorD input = i > 0              ? through(down_[i], t, error.row(t))
                               : is_binary(layer) ? through_data(down_[i], t, error.row(t))
                                                  : RowVectorD(error.row(t));
      gradient.visible_bias += input;
      gradient.weights += input.transpose() * above.row(t);
      gradient.visible_history += history(down_[i].dropped, t, order).transpose() * input;
      error_above.row(t) = input * layer.weights;
      for (Eigen::Index lag = 0; lag < order; ++lag)
        if (t - order + lag >= first_)
          error.row(t - order + lag) +=
              input * layer.visible_history.middleRows(lag * width, width).transpose();
    }
    error = std::move(error_above);
  }
  return error;
}

MatrixD UnrolledGradient::back_through_mean_field(UnrolledModel& sum, const MatrixD& error) const {
  const Mrbm& mrbm = model_.mrbm;
  MatrixD code_error = MatrixD::Zero(frames_, up_.back().own.cols());
  for (Eigen::Index t = first_; t < frames_; ++t) {
    RowVectorD missing_error = error.row(t);
    for (std::size_t s = shared_.size(); s-- > 0;) {
      const RowVectorD down = through(missing_[s + 1], t, missing_error);
      const RowVectorD up = through(shared_[s], t, down * mrbm.weights[q_]);
      sum.mrbm.visible_bias[q_] += down;
      sum.mrbm.weights[q_] += down.transpose() * shared_[s].dropped.row(t);
      sum.mrbm.weights[q_] += missing_[s].own.row(t).transpose() * up;
      sum.mrbm.weights[p_] += up_.back().dropped.row(t).transpose() * up;
      sum.mrbm.hidden_bias += up;
      code_error.row(t) += up * mrbm.weights[p_].transpose();
      missing_error = up * mrbm.weights[q_].transpose();
    }
  }
  return code_error;
}

void UnrolledGradient::back_up(UnrolledModel& sum, MatrixD error) const {
  for (std::size_t i = up_.size(); i-- > 0;) {
    const Crbm& layer = model_.stacks[p_][i];
    Crbm& gradient = sum.stacks[p_][i];
    const MatrixD& below = i > 0 ? up_[i - 1].dropped : values_;
    const Eigen::Index order = order_B(layer), width = layer.visible_bias.size();
    MatrixD error_below = MatrixD::Zero(frames_, width);
    for (Eigen::Index t = order_of(layer); t < frames_; ++t) {
      const RowVectorD input = through(up_[i], t, error.row(t));
      gradient.hidden_bias += input;
      gradient.weights += below.row(t).transpose() * input;
      gradient.hidden_history += history(below, t, order).transpose() * input;
      error_below.row(t) += input * layer.weights.transpose();
      for (Eigen::Index lag = 0; lag < order; ++lag)
        error_below.row(t - order + lag) +=
            input * layer.hidden_history.middleRows(lag * width, width).transpose();
    }
    error = std::move(error_below);
  }
}

}  // namespace mcdbn::reference
