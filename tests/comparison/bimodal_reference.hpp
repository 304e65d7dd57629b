#pragma once

#include <array>
#include <vector>

#include "comparison/dense_network.hpp"

namespace mcdbn::test {

/// The bimodal autoencoder in double, layers numbered as BimodalNetwork has them: encoders 0 and 1,
/// 2 and 3 to the shared units, 4 and 5 from them, decoders 6 and 7.
struct BimodalReference {
  struct Layer {
    MatrixD W, b;
  };
  struct Pass {
    std::array<MatrixD, 2> hidden, unshared, output;
    MatrixD shared;
  };
  std::vector<Layer> layers;

  explicit BimodalReference(const std::vector<DenseLayer>& start) {
    for (const DenseLayer& layer : start)
      layers.push_back({layer.W.cast<double>(), layer.b.cast<double>()});
  }

  static MatrixD sigmoid(const MatrixD& x) { return (1 / (1 + (-x.array()).exp())).matrix(); }
  MatrixD image(std::size_t layer, const MatrixD& input) const {
    return (input * layers[layer].W).rowwise() + RowVectorD(layers[layer].b.row(0));
  }

  Pass pass(const std::array<MatrixD, 2>& input) const {
    Pass all;
    for (std::size_t m = 0; m < 2; ++m) all.hidden[m] = sigmoid(image(m, input[m]));
    all.shared = sigmoid(image(2, all.hidden[0]) + image(3, all.hidden[1]));
    for (std::size_t m = 0; m < 2; ++m) {
      all.unshared[m] = sigmoid(image(4 + m, all.shared));
      all.output[m] = image(6 + m, all.unshared[m]);
    }
    return all;
  }

  /// ½ Σ_m weight · ‖output − target‖² a row.
  double loss(const std::array<MatrixD, 2>& input, const std::array<MatrixD, 2>& target,
              const std::array<double, 2>& weight) const {
    const Pass all = pass(input);
    double sum = 0;
    for (std::size_t m = 0; m < 2; ++m)
      sum += 0.5 * weight[m] * (all.output[m] - target[m]).squaredNorm();
    return sum / static_cast<double>(target[0].rows());
  }

  std::vector<Layer> gradient(const std::array<MatrixD, 2>& input,
                              const std::array<MatrixD, 2>& target,
                              const std::array<double, 2>& weight) const {
    const Pass all = pass(input);
    std::vector<Layer> result(8);
    const auto through = [&](std::size_t layer, const MatrixD& units, const MatrixD& error) {
      result[layer] = {units.transpose() * error, error.colwise().sum()};
      const MatrixD slope = units.array() * (1 - units.array());
      return MatrixD((error * layers[layer].W.transpose()).cwiseProduct(slope));
    };
    MatrixD shared = MatrixD::Zero(all.shared.rows(), all.shared.cols());
    for (std::size_t m = 0; m < 2; ++m) {
      const MatrixD error =
          weight[m] * (all.output[m] - target[m]) / static_cast<double>(target[m].rows());
      shared += through(4 + m, all.shared, through(6 + m, all.unshared[m], error));
    }
    for (std::size_t m = 0; m < 2; ++m) {
      const MatrixD error = through(2 + m, all.hidden[m], shared);
      result[m] = {input[m].transpose() * error, error.colwise().sum()};
    }
    return result;
  }
};

}  // namespace mcdbn::test
