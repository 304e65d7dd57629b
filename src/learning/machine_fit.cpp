#include "mcdbn/learning/machine_fit.hpp"

#include <fmt/format.h>

#include "base/random_streams.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"

namespace mcdbn {
namespace {

LearningSettings learning_of(const MachineSettings& settings) {
  settings.validate();
  LearningSettings learning;
  learning.seed = settings.seed;
  learning.hidden = learning.mrbm_hidden = settings.hidden;
  learning.look_ahead = 0;
  learning.batch = settings.batch;
  learning.least_batches = settings.least_batches;
  learning.gaussian = settings.gaussian;
  learning.binary = settings.binary;
  learning.mrbm = settings.mrbm;
  return learning;
}

void check_layers(const std::vector<LayerSize>& layers) {
  if (layers.empty()) throw ShapeError("a stack without layers");
  check_range("the number of layers", size_limits::kLayers, static_cast<double>(layers.size()));
  for (std::size_t i = 0; i < layers.size(); ++i) {
    check_range(fmt::format("`hidden` of layer {}", i), size_limits::kUnits,
                static_cast<double>(layers[i].hidden));
    check_range(fmt::format("`order` of layer {}", i), size_limits::kHistory,
                static_cast<double>(layers[i].order));
  }
}

}  // namespace

std::vector<LayerSize> equal_layers(const MachineSettings& settings, bool history) {
  const LayerSize layer{settings.hidden, history ? settings.order : 0};
  return std::vector<LayerSize>(settings.layers, layer);
}

Cdbn fit_stack(Device& device, const Sequences& data, VisibleKind kind,
               const std::vector<LayerSize>& layers, const MachineSettings& settings,
               const EpochObserver& observer) {
  check_layers(layers);
  const LearningSettings learning = learning_of(settings);
  std::vector<CrbmShape> shapes;
  shapes.reserve(layers.size());
  for (const LayerSize& layer : layers)
    shapes.push_back({shapes.empty() ? data.values.columns() : shapes.back().hidden, layer.hidden,
                      layer.order, shapes.empty() ? kind : VisibleKind::binary});
  return train_cdbn(device, data, shapes, learning, random_streams::layers_of(0), observer, "layer")
      .cdbn;
}

Mrbm fit_mrbm(Device& device, const std::vector<Modality>& modalities,
              std::span<const Sequences> data, const MachineSettings& settings,
              const EpochObserver& observer) {
  const LearningSettings learning = learning_of(settings);
  MrbmShape shape{modalities, settings.hidden};
  if (modalities.size() != data.size()) throw ShapeError("MRBM: other modalities than data");
  for (std::size_t m = 0; m < data.size(); ++m)
    shape.modalities[m].visible = data[m].values.columns();
  shape.check();
  return train_mrbm(device, data, initial_mrbm_weights(shape, data, learning), learning,
                    random_streams::kMrbm, observer);
}

}  // namespace mcdbn
