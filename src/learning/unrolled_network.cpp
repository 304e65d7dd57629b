#include "learning/unrolled_network.hpp"

#include <utility>

#include "device/pointwise.hpp"

namespace mcdbn {
namespace {

constexpr float kCenter = 0.5F;

/// What moving the units' zero by `sign` halves does to the biases.
CrbmParameters shifted(CrbmParameters layer, float sign) {
  const float hidden = sign * kCenter;
  const float visible = layer.shape.kind == VisibleKind::binary ? sign * kCenter : 0.0F;
  layer.b += visible * (layer.W.colwise().sum() + layer.B.colwise().sum());
  layer.a += hidden * layer.W.rowwise().sum().transpose() + visible * layer.A.colwise().sum();
  layer.visible_mean.array() -= visible;
  return layer;
}

MrbmParameters shifted(MrbmParameters mrbm, float sign) {
  for (std::size_t m = 0; m < 2; ++m) {
    mrbm.b += sign * kCenter * mrbm.W[m].colwise().sum();
    mrbm.a[m] += sign * kCenter * mrbm.W[m].rowwise().sum().transpose();
  }
  return mrbm;
}

}  // namespace

CrbmParameters centered(CrbmParameters layer) {
  return shifted(std::move(layer), 1.0F);
}
CrbmParameters uncentered(CrbmParameters layer) {
  return shifted(std::move(layer), -1.0F);
}
MrbmParameters centered(MrbmParameters mrbm) {
  return shifted(std::move(mrbm), 1.0F);
}
MrbmParameters uncentered(MrbmParameters mrbm) {
  return shifted(std::move(mrbm), -1.0F);
}

TrainedParameter::TrainedParameter(Matrix& trained, bool weights)
    : value(&trained),
      is_weight(weights),
      gradient(Matrix::like(trained)),
      mean(Matrix::like(trained)),
      square(Matrix::like(trained)),
      average(Matrix::like(trained)) {
  average.copy_from(trained);
}

UnrolledNetwork::Layer::Layer(Device& device, const CrbmParameters& parameters)
    : crbm(device, parameters),
      W(crbm.W, true),
      A(crbm.A, true),
      B(crbm.B, true),
      a(crbm.a, false),
      b(crbm.b, false),
      A_following(device, parameters.shape.order * crbm.A.stride(), parameters.shape.visible),
      B_following(device, parameters.shape.order * crbm.B.stride(), parameters.shape.visible) {}

UnrolledNetwork::UnrolledNetwork(Device& device, const Mcdbn& start, std::size_t mean_field_steps)
    : look_ahead_(start.look_ahead),
      mean_field_steps_(mean_field_steps),
      mrbm_(device, centered(start.mrbm.to_host())),
      mrbm_b_(mrbm_.b, false),
      limit_(device, 5 * (start.track.layers.size() + start.pose.layers.size()) + 5) {
  for (const Modality modality : {Modality::track, Modality::pose}) {
    for (const Crbm& layer : start.cdbn(modality).layers)
      layers(modality).emplace_back(device, centered(layer.to_host()));
    mrbm_W_.emplace_back(mrbm_.W[index_of(modality)], true);
    mrbm_a_.emplace_back(mrbm_.a[index_of(modality)], false);
  }
  refresh_copies();
}

std::vector<TrainedParameter*> UnrolledNetwork::parameters() {
  std::vector<TrainedParameter*> all;
  for (auto& stack : layers_)
    for (Layer& layer : stack)
      for (TrainedParameter* parameter : {&layer.W, &layer.A, &layer.B, &layer.a, &layer.b})
        all.push_back(parameter);
  for (std::size_t m = 0; m < 2; ++m) {
    all.push_back(&mrbm_W_[m]);
    all.push_back(&mrbm_a_[m]);
  }
  all.push_back(&mrbm_b_);
  return all;
}

void UnrolledNetwork::clear_gradients() {
  for (TrainedParameter* parameter : parameters()) parameter->gradient.set_zero();
}

void UnrolledNetwork::update(const AdamRule& rule, float longest_gradient, float average_kept) {
  ++updates_;
  std::vector<const Matrix*> gradients;
  for (const TrainedParameter* parameter : parameters()) gradients.push_back(&parameter->gradient);
  limit_.measure(gradients, longest_gradient);
  AdamRule biases = rule;
  biases.weight_decay = 0.0F;
  for (TrainedParameter* parameter : parameters()) {
    adam_update(*parameter->value, parameter->mean, parameter->square, parameter->gradient,
                parameter->is_weight ? rule : biases, updates_, &limit_.scale());
    average_update(parameter->average, *parameter->value, 1.0F - average_kept);
  }
  refresh_copies();
}

void UnrolledNetwork::refresh_copies() {
  for (auto& stack : layers_)
    for (Layer& layer : stack) {
      layer.crbm.refresh_transposed();
      const std::size_t order = layer.crbm.shape().order;
      if (order == 0) continue;
      transpose_lags(layer.crbm.A, order, layer.A_following);
      transpose_lags(layer.crbm.B, order, layer.B_following);
    }
  mrbm_.refresh_transposed();
}

void UnrolledNetwork::exchange_averages() {
  for (TrainedParameter* parameter : parameters()) std::swap(*parameter->value, parameter->average);
  refresh_copies();
}

Mcdbn UnrolledNetwork::averaged() {
  exchange_averages();
  Mcdbn result{{}, {}, Mrbm(device(), uncentered(mrbm_.to_host())), look_ahead_, mean_field_steps_};
  for (const Modality modality : {Modality::track, Modality::pose}) {
    for (const Layer& layer : layers(modality))
      result.cdbn(modality).layers.emplace_back(device(), uncentered(layer.crbm.to_host()));
  }
  exchange_averages();
  result.fills_gaps = false;
  return result;
}

}  // namespace mcdbn
