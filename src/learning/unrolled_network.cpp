#include "learning/unrolled_network.hpp"

#include <fmt/format.h>

#include <utility>

#include "device/pointwise.hpp"

namespace mcdbn {
namespace {

constexpr float kCenter = 0.5F;
constexpr const char* kMrbmPrefix = "mrbm.";

/// The layer with its units' zero moved by `sign` halves, which changes the biases.
CrbmParameters shifted(CrbmParameters layer, InputKind input_kind, float sign) {
  const float hidden = sign * kCenter;
  const float visible = input_kind == InputKind::code ? sign * kCenter : 0.0F;
  layer.b += visible * (layer.W.colwise().sum() + layer.B.colwise().sum());
  layer.a += hidden * layer.W.rowwise().sum().transpose() + visible * layer.A.colwise().sum();
  layer.visible_mean.array() -= visible;
  return layer;
}

MrbmParameters shifted(MrbmParameters mrbm, float sign) {
  for (std::size_t m = 0; m < mrbm.W.size(); ++m) {
    mrbm.b += sign * kCenter * mrbm.W[m].colwise().sum();
    mrbm.a[m] += sign * kCenter * mrbm.W[m].rowwise().sum().transpose();
  }
  return mrbm;
}

InputKind input_kind_of(std::size_t layer) {
  return layer == 0 ? InputKind::data : InputKind::code;
}

/// `track.0.`
std::string prefix_of(const Modality& modality, std::size_t layer) {
  return fmt::format("{}.{}.", modality.name, layer);
}

std::vector<ParameterShape> parameter_shapes(const Mcdbn& network) {
  std::vector<ParameterShape> all;
  const auto add = [&all](std::vector<ParameterShape> shapes, const std::string& prefix) {
    for (ParameterShape& shape : shapes) {
      shape.name.insert(0, prefix);
      all.push_back(std::move(shape));
    }
  };
  for (std::size_t m = 0; m < network.modality_count(); ++m) {
    const auto& layers = network.cdbns[m].layers;
    for (std::size_t i = 0; i < layers.size(); ++i)
      add(Crbm::parameter_shapes(layers[i].shape()), prefix_of(network.modality(m), i));
  }
  add(Mrbm::parameter_shapes(network.mrbm.shape()), kMrbmPrefix);
  return all;
}

}  // namespace

CrbmParameters centered(CrbmParameters layer, InputKind input_kind) {
  return shifted(std::move(layer), input_kind, 1.0F);
}
CrbmParameters uncentered(CrbmParameters layer, InputKind input_kind) {
  return shifted(std::move(layer), input_kind, -1.0F);
}
MrbmParameters centered(MrbmParameters mrbm) {
  return shifted(std::move(mrbm), 1.0F);
}
MrbmParameters uncentered(MrbmParameters mrbm) {
  return shifted(std::move(mrbm), -1.0F);
}

UnrolledNetwork::Layer::Layer(const Parameters& parameters, const Parameters& gradients,
                              const CrbmParameters& start, InputKind input_kind)
    : crbm(parameters, start.shape, start.visible_mean, start.visible_deviation),
      gradient(gradients),
      A_following(parameters.device(), start.shape.order_A() * crbm.A.stride(),
                  start.shape.visible) {
  if (input_kind == InputKind::code)
    B_following =
        Matrix(parameters.device(), start.shape.order_B() * crbm.B.stride(), start.shape.visible);
}

UnrolledNetwork::UnrolledNetwork(Device& device, const Mcdbn& start, std::size_t mean_field_steps)
    : look_ahead_(start.look_ahead),
      mean_field_steps_(mean_field_steps),
      parameters_(device, parameter_shapes(start)),
      optimizer_(parameters_, OptimizerKind::adam),
      layers_(start.modality_count()),
      mrbm_(parameters_.part(kMrbmPrefix), start.mrbm.shape()),
      mrbm_gradient_(parameters_.in(optimizer_.gradients()).part(kMrbmPrefix), start.mrbm.shape()),
      limit_(parameters_),
      averages_(Matrix::like(parameters_.all())),
      spare_(Matrix::like(parameters_.all())) {
  const Parameters gradients = parameters_.in(optimizer_.gradients());
  for (std::size_t m = 0; m < layers_.size(); ++m)
    for (const Crbm& layer : start.cdbns[m].layers) {
      const std::string prefix = prefix_of(start.modality(m), layers_[m].size());
      const CrbmParameters own = centered(layer.to_host(), input_kind_of(layers_[m].size()));
      own.write(parameters_.part(prefix));
      layers_[m].emplace_back(parameters_.part(prefix), gradients.part(prefix), own,
                              input_kind_of(layers_[m].size()));
    }
  centered(start.mrbm.to_host()).write(mrbm_.parameters());
  averages_.copy_from(parameters_.all());
  refresh_copies();
}

void UnrolledNetwork::update(const UpdateRule& rule, float longest_gradient, float average_kept) {
  limit_.measure(optimizer_.gradients(), longest_gradient);
  optimizer_.next_step();
  optimizer_.update(rule, &limit_.scale());
  average_update(averages_, parameters_.all(), 1.0F - average_kept);
  refresh_copies();
}

void UnrolledNetwork::refresh_copies() {
  for (auto& stack : layers_)
    for (Layer& layer : stack) {
      layer.crbm.refresh_transposed();
      const CrbmShape& shape = layer.crbm.shape();
      if (shape.order_A() > 0) transpose_lags(layer.crbm.A, shape.order_A(), layer.A_following);
      if (!layer.B_following.empty())
        transpose_lags(layer.crbm.B, shape.order_B(), layer.B_following);
    }
  mrbm_.refresh_transposed();
}

void UnrolledNetwork::exchange_averages() {
  spare_.copy_from(parameters_.all());
  parameters_.copy_from(averages_);
  averages_.copy_from(spare_);
  refresh_copies();
}

Mcdbn UnrolledNetwork::with_parameters(const Matrix& values) {
  spare_.copy_from(parameters_.all());
  parameters_.copy_from(values);
  Mcdbn result{std::vector<Cdbn>(layers_.size()), Mrbm(device(), uncentered(mrbm_.to_host())),
               look_ahead_, mean_field_steps_};
  for (std::size_t m = 0; m < layers_.size(); ++m)
    for (const Layer& layer : layers_[m]) {
      auto& own = result.cdbns[m].layers;
      own.emplace_back(device(), uncentered(layer.crbm.to_host(), input_kind_of(own.size())));
    }
  parameters_.copy_from(spare_);
  result.fills_gaps = false;
  return result;
}

void UnrolledNetwork::visit_state(TrainingState& state) {
  state.parameters("parameters", parameters_);
  state.matrix("averages", averages_);
  optimizer_.visit_state(state);
  if (state.restores()) refresh_copies();
}

}  // namespace mcdbn
