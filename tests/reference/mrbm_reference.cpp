#include "reference/mrbm_reference.hpp"

#include <algorithm>

#include "reference/units_reference.hpp"

namespace mcdbn::reference {
namespace {

MatrixD sigmoid_gradient(const MatrixD& y) {
  return y.array() * (1.0 - y.array());
}

/// What an error behind the units of modality m is before them.
MatrixD through_units(const Mrbm& model, std::size_t m, const MatrixD& error,
                      const MatrixD& units) {
  return model.is_gaussian(m) ? error : MatrixD(error.cwiseProduct(sigmoid_gradient(units)));
}

/// Adds one direction's loss and gradient, both summed over the batch.
void add_direction(const Mrbm& model, std::size_t missing, const std::vector<MatrixD>& batch,
                   int steps, MultiPrediction& sum) {
  const MatrixD& target = batch[missing];
  const MeanFieldTrace trace = mean_field(model, missing, batch, steps);
  sum.loss += prediction_loss(model, missing, target, trace.missing_input);

  MatrixD visible_delta = trace.missing.back() - target;  // before eq 33's units, of either kind
  for (int pass = steps - 1; pass >= 0; --pass) {
    const MatrixD& hidden = trace.hidden[pass];
    const MatrixD& before = trace.missing[pass];
    const MatrixD hidden_delta =
        (visible_delta * model.weights[missing]).cwiseProduct(sigmoid_gradient(hidden));
    sum.gradient.weights[missing] +=
        visible_delta.transpose() * hidden + before.transpose() * hidden_delta;
    for (std::size_t m = 0; m < batch.size(); ++m)
      if (m != missing) sum.gradient.weights[m] += batch[m].transpose() * hidden_delta;
    sum.gradient.visible_bias[missing] += visible_delta.colwise().sum();
    sum.gradient.hidden_bias += hidden_delta.colwise().sum();
    visible_delta =
        through_units(model, missing, hidden_delta * model.weights[missing].transpose(), before);
  }
}

}  // namespace

Eigen::VectorXd Mrbm::flattened() const {
  Eigen::Index size = hidden_bias.size();
  for (std::size_t m = 0; m < weights.size(); ++m)
    size += weights[m].size() + visible_bias[m].size();
  Eigen::VectorXd flat(size);
  Eigen::Index at = 0;
  const auto put = [&](const auto& parameter) {
    std::copy_n(parameter.data(), parameter.size(), flat.data() + at);
    at += parameter.size();
  };
  for (const MatrixD& matrix : weights) put(matrix);
  for (const RowVectorD& row : visible_bias) put(row);
  put(hidden_bias);
  return flat;
}

Mrbm Mrbm::with_parameters(const Eigen::VectorXd& flat) const {
  Mrbm result = *this;
  Eigen::Index at = 0;
  const auto take = [&](auto& parameter) {
    std::copy_n(flat.data() + at, parameter.size(), parameter.data());
    at += parameter.size();
  };
  for (MatrixD& matrix : result.weights) take(matrix);
  for (RowVectorD& row : result.visible_bias) take(row);
  take(result.hidden_bias);
  return result;
}

MeanFieldTrace mean_field(const Mrbm& model, std::size_t missing, const std::vector<MatrixD>& batch,
                          int steps) {
  const Eigen::Index rows = batch[missing == 0 ? 1 : 0].rows();
  MatrixD from_present = MatrixD::Zero(rows, model.hidden_bias.size());
  for (std::size_t m = 0; m < batch.size(); ++m)
    if (m != missing) from_present += batch[m] * model.weights[m];
  MeanFieldTrace trace;
  trace.missing.push_back(MatrixD::Zero(rows, model.weights[missing].rows()));
  for (int pass = 0; pass < steps; ++pass) {
    const MatrixD hidden_input =
        plus_row(from_present + trace.missing.back() * model.weights[missing], model.hidden_bias);
    trace.hidden.push_back(sigmoid(hidden_input));
    trace.missing_input = plus_row(trace.hidden.back() * model.weights[missing].transpose(),
                                   model.visible_bias[missing]);
    trace.missing.push_back(model.is_gaussian(missing) ? trace.missing_input
                                                       : sigmoid(trace.missing_input));
  }
  return trace;
}

double prediction_loss(const Mrbm& model, std::size_t missing, const MatrixD& target,
                       const MatrixD& input) {
  return model.is_gaussian(missing) ? 0.5 * (input - target).squaredNorm()
                                    : cross_entropy_of_sigmoid(target, input);
}

MultiPrediction multi_prediction(const Mrbm& model, const std::vector<MatrixD>& batch, int steps) {
  MultiPrediction sum;
  sum.gradient = model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
  for (std::size_t m = 0; m < batch.size(); ++m) add_direction(model, m, batch, steps, sum);
  const double scale = 1.0 / static_cast<double>(batch[0].rows());
  sum.loss *= scale;
  sum.gradient = model.with_parameters(scale * sum.gradient.flattened());
  return sum;
}

}  // namespace mcdbn::reference
