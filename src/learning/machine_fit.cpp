#include "mcdbn/learning/machine_fit.hpp"

#include <fmt/format.h>

#include <cmath>

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

/// @throws InputError for what a machine with visible units of this kind cannot learn from
void check_values(const Sequences& data, VisibleKind kind, const std::string& what) {
  const MatrixF values = data.values.to_host();
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      const float x = values(r, c);
      if (!std::isfinite(x))
        throw InputError(fmt::format("{}: row {}, column {} is {}; numbers are needed throughout",
                                     what, r + 1, c + 1, x));
      if (kind == VisibleKind::binary && (x < 0.0F || x > 1.0F))
        throw InputError(fmt::format(
            "{}: row {}, column {} is {}; binary units need values from 0 to 1 (Gaussian ones take "
            "any)",
            what, r + 1, c + 1, x));
    }
}

}  // namespace

Cdbn fit_stack(Device& device, const Sequences& data, VisibleKind kind,
               const std::vector<LayerSize>& layers, const MachineSettings& settings,
               const EpochObserver& observer) {
  check_layers(layers);
  const LearningSettings learning = learning_of(settings);
  check_values(data, kind, "data");
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
  for (std::size_t m = 0; m < data.size(); ++m) {
    shape.modalities[m].visible = data[m].values.columns();
    if (data[m].values.rows() != data.front().values.rows())
      throw ShapeError("MRBM: modalities differ in rows");
  }
  shape.check();
  for (std::size_t m = 0; m < data.size(); ++m)
    check_values(data[m], modalities[m].kind, modalities[m].name);
  return train_mrbm(device, data, small_weights(shape, data, learning), learning,
                    random_streams::kMrbm, observer);
}

}  // namespace mcdbn
