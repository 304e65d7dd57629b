#include "comparison/dense_network.hpp"

#include <fmt/format.h>

#include <cmath>

#include "device/pointwise.hpp"

namespace mcdbn {
namespace {

/// `0.W`
std::string name_of(std::size_t layer, const char* letter) {
  return fmt::format("{}.{}", layer, letter);
}

Parameters uploaded(Device& device, const std::vector<DenseLayer>& layers) {
  std::vector<ParameterShape> shapes;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto rows = static_cast<std::size_t>(layers[i].W.rows());
    const auto columns = static_cast<std::size_t>(layers[i].W.cols());
    shapes.push_back({.name = name_of(i, "W"), .rows = rows, .columns = columns});
    shapes.push_back({.name = name_of(i, "b"), .rows = 1, .columns = columns, .is_weight = false});
  }
  Parameters parameters(device, shapes);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    parameters.upload(name_of(i, "W"), layers[i].W);
    parameters.upload(name_of(i, "b"), layers[i].b);
  }
  return parameters;
}

}  // namespace

DenseLayer random_dense_layer(std::size_t inputs, std::size_t rows, std::size_t outputs,
                              const RandomKey& key) {
  const double deviation = std::sqrt(1.0 / (3.0 * static_cast<double>(inputs)));
  DenseLayer layer{MatrixF(rows, outputs), MatrixF::Zero(1, outputs)};
  for (Eigen::Index r = 0; r < layer.W.rows(); ++r)
    for (Eigen::Index c = 0; c < layer.W.cols(); ++c)
      layer.W(r, c) =
          static_cast<float>(deviation * random_normal(key, static_cast<std::uint32_t>(r),
                                                       static_cast<std::uint32_t>(c)));
  return layer;
}

DenseNetwork::DenseNetwork(Device& device, const std::vector<DenseLayer>& start)
    : optimizer_(uploaded(device, start), OptimizerKind::adam) {
  const Parameters gradients = parameters().in(optimizer_.gradients());
  for (std::size_t i = 0; i < start.size(); ++i) {
    Layer layer{parameters().matrix(name_of(i, "W")),
                parameters().matrix(name_of(i, "b")),
                gradients.matrix(name_of(i, "W")),
                gradients.matrix(name_of(i, "b")),
                {}};
    layer.W_transposed = Matrix(device, layer.W.columns(), layer.W.rows());
    transpose(layer.W, layer.W_transposed);
    layers_.push_back(std::move(layer));
  }
}

void DenseNetwork::forward(std::size_t layer, const Rows& input, const Rows& output,
                           Activation activation, bool add) const {
  GemmOptions options;
  options.bias = &layers_[layer].b;
  options.activation = activation;
  options.beta = add ? 1.0F : 0.0F;
  gemm(input, layers_[layer].W, output, options);
}

void DenseNetwork::backward(std::size_t layer, const Rows& error, const Rows& error_below,
                            const Slope& slope) const {
  GemmOptions options;
  options.activation = slope.gradient;
  options.factor = slope.units;
  options.alpha = slope.scale;
  options.beta = slope.add ? 1.0F : 0.0F;
  gemm(error, layers_[layer].W_transposed, error_below, options);
}

void DenseNetwork::differentiate(std::size_t layer, const Rows& input, const Rows& error) {
  gemm_transposed_a(input, error, layers_[layer].gradient_W);
  column_sum(error, 1.0F, 0.0F, layers_[layer].gradient_b);
}

void DenseNetwork::update(const UpdateRule& rule) {
  optimizer_.next_step();
  optimizer_.update(rule);
  for (Layer& layer : layers_) transpose(layer.W, layer.W_transposed);
}

std::vector<DenseLayer> DenseNetwork::gradients() const {
  std::vector<DenseLayer> layers;
  for (const Layer& layer : layers_)
    layers.push_back({layer.gradient_W.to_host(), layer.gradient_b.to_host()});
  return layers;
}

std::vector<DenseLayer> DenseNetwork::to_host() const {
  std::vector<DenseLayer> layers;
  for (const Layer& layer : layers_) layers.push_back({layer.W.to_host(), layer.b.to_host()});
  return layers;
}

}  // namespace mcdbn
