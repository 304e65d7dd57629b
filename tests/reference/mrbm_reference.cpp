#include "reference/mrbm_reference.hpp"

#include <algorithm>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

double present_weight(const MeanFieldOptions& options, int pass) {
  return options.double_first_pass && pass == 0 ? 2.0 : 1.0;
}

MatrixD sigmoid_gradient(const MatrixD& y) {
  return y.array() * (1.0 - y.array());
}

/// Adds one direction's loss and gradient, both summed over the batch.
void add_direction(const Mrbm& model, int present, const std::array<MatrixD, 2>& batch,
                   const MeanFieldOptions& options, MultiPrediction& sum) {
  const int missing = 1 - present;
  const MatrixD& target = batch[missing];
  const MeanFieldTrace trace = mean_field(model, present, batch[present], options);
  sum.loss += cross_entropy_of_sigmoid(target, trace.missing_input);

  MatrixD visible_delta = trace.missing.back() - target;  // at the input of eq 33's sigmoid
  for (int pass = options.steps - 1; pass >= 0; --pass) {
    const MatrixD& hidden = trace.hidden[pass];
    const MatrixD& before = trace.missing[pass];
    const MatrixD hidden_delta =
        (visible_delta * model.weights[missing]).cwiseProduct(sigmoid_gradient(hidden));
    sum.gradient.weights[missing] +=
        visible_delta.transpose() * hidden + before.transpose() * hidden_delta;
    sum.gradient.weights[present] +=
        present_weight(options, pass) * batch[present].transpose() * hidden_delta;
    sum.gradient.visible_bias[missing] += visible_delta.colwise().sum();
    sum.gradient.hidden_bias += hidden_delta.colwise().sum();
    visible_delta =
        (hidden_delta * model.weights[missing].transpose()).cwiseProduct(sigmoid_gradient(before));
  }
}

}  // namespace

Eigen::VectorXd Mrbm::flattened() const {
  Eigen::VectorXd flat(weights[0].size() + weights[1].size() + visible_bias[0].size() +
                       visible_bias[1].size() + hidden_bias.size());
  flat << weights[0].reshaped<Eigen::RowMajor>(), weights[1].reshaped<Eigen::RowMajor>(),
      visible_bias[0].transpose(), visible_bias[1].transpose(), hidden_bias.transpose();
  return flat;
}

Mrbm Mrbm::with_parameters(const Eigen::VectorXd& flat) const {
  Mrbm result = *this;
  Eigen::Index at = 0;
  const auto take = [&](auto& parameter) {
    std::copy_n(flat.data() + at, parameter.size(), parameter.data());
    at += parameter.size();
  };
  take(result.weights[0]);
  take(result.weights[1]);
  take(result.visible_bias[0]);
  take(result.visible_bias[1]);
  take(result.hidden_bias);
  return result;
}

MeanFieldTrace mean_field(const Mrbm& model, int present, const MatrixD& values,
                          const MeanFieldOptions& options) {
  const int missing = 1 - present;
  const MatrixD from_present = values * model.weights[present];
  MeanFieldTrace trace;
  trace.missing.push_back(MatrixD::Zero(values.rows(), model.weights[missing].rows()));
  for (int pass = 0; pass < options.steps; ++pass) {
    const MatrixD hidden_input = plus_row(present_weight(options, pass) * from_present +
                                              trace.missing.back() * model.weights[missing],
                                          model.hidden_bias);
    trace.hidden.push_back(sigmoid(hidden_input));
    trace.missing_input = plus_row(trace.hidden.back() * model.weights[missing].transpose(),
                                   model.visible_bias[missing]);
    trace.missing.push_back(sigmoid(trace.missing_input));
  }
  return trace;
}

MultiPrediction multi_prediction(const Mrbm& model, const std::array<MatrixD, 2>& batch,
                                 const MeanFieldOptions& options) {
  MultiPrediction sum;
  sum.gradient = model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
  add_direction(model, 0, batch, options, sum);
  add_direction(model, 1, batch, options, sum);
  const double scale = 1.0 / static_cast<double>(batch[0].rows());
  sum.loss *= scale;
  sum.gradient = model.with_parameters(scale * sum.gradient.flattened());
  return sum;
}

}  // namespace mcdbn::reference
