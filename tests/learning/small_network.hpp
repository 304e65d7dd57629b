#pragma once

#include <array>
#include <vector>

#include "device/every_device.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/machines/mcdbn.hpp"
#include "reference/unrolled_reference.hpp"

namespace mcdbn::test {

/// A layer of a small network: its hidden units and its frames of history, A's and B's own if
/// given.
struct LayerSize {
  std::size_t hidden, order;
  std::optional<std::size_t> own_order_A = {}, own_order_B = {};
};

/// What a small network is built from: random parameters in single precision.
struct NetworkParameters {
  std::array<std::vector<CrbmParameters>, 2> stacks;  ///< 2D, 3D
  MrbmParameters mrbm;
};

inline CrbmParameters random_layer(const CrbmShape& shape, unsigned seed) {
  CrbmParameters layer = CrbmParameters::zeros(shape);
  layer.W = random_matrix(shape.visible, shape.hidden, seed, 0.7F);
  layer.A = random_matrix(shape.order_A() * shape.visible, shape.visible, seed + 1, 0.12F);
  layer.B = random_matrix(shape.order_B() * shape.visible, shape.hidden, seed + 2, 0.4F);
  layer.a = random_matrix(1, shape.visible, seed + 3, 0.5F);
  layer.b = random_matrix(1, shape.hidden, seed + 4, 0.5F);
  if (shape.kind == VisibleKind::binary)
    layer.visible_mean = (0.5F + 0.2F * random_matrix(1, shape.visible, seed + 5).array()).matrix();
  return layer;
}

/// @param visible units of 2D and of 3D  @param sizes the layers of 2D and of 3D, from below
inline NetworkParameters random_network(const std::array<std::size_t, 2>& visible,
                                        const std::array<std::vector<LayerSize>, 2>& sizes,
                                        std::size_t shared, unsigned seed) {
  NetworkParameters network;
  network.mrbm.shape = two_modalities(sizes[0].back().hidden, sizes[1].back().hidden, shared);
  for (std::size_t m = 0; m < 2; ++m) {
    std::size_t below = visible[m];
    for (const LayerSize& size : sizes[m]) {
      const bool lowest = network.stacks[m].empty();
      network.stacks[m].push_back(random_layer(
          {below, size.hidden, size.order, lowest ? VisibleKind::gaussian : VisibleKind::binary,
           size.own_order_A, size.own_order_B},
          seed += 10));
      below = size.hidden;
    }
    network.mrbm.W.push_back(random_matrix(below, shared, seed += 10, 0.8F));
    network.mrbm.a.push_back(random_matrix(1, below, seed += 10, 0.5F));
  }
  network.mrbm.b = random_matrix(1, shared, seed += 10, 0.5F);
  return network;
}

inline Mcdbn on_device(Device& device, const NetworkParameters& parameters, std::size_t look_ahead,
                       std::size_t mean_field_steps) {
  Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, parameters.mrbm), look_ahead, mean_field_steps};
  for (const std::size_t modality : {modality::track, modality::pose})
    for (const CrbmParameters& layer : parameters.stacks[modality])
      network.cdbns[modality].layers.emplace_back(device, layer);
  return network;
}

inline NetworkParameters on_host(const Mcdbn& network) {
  NetworkParameters parameters;
  for (const std::size_t modality : {modality::track, modality::pose})
    for (const Crbm& layer : network.cdbns[modality].layers)
      parameters.stacks[modality].push_back(layer.to_host());
  parameters.mrbm = network.mrbm.to_host();
  return parameters;
}

inline reference::UnrolledModel in_double(const NetworkParameters& parameters) {
  reference::UnrolledModel model;
  model.stacks.resize(2);
  model.start.resize(2);
  for (std::size_t m = 0; m < 2; ++m) {
    for (const CrbmParameters& own : parameters.stacks[m]) {
      model.stacks[m].push_back(in_double(own));
      model.start[m].push_back(own.visible_mean.cast<double>());
    }
  }
  model.mrbm = in_double(parameters.mrbm);
  return model;
}

}  // namespace mcdbn::test
