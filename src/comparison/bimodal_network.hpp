#pragma once

#include <array>

#include "comparison/bimodal_data.hpp"
#include "comparison/dense_network.hpp"
#include "device/losses.hpp"

namespace mcdbn {

/// The layers of a bimodal autoencoder. In arrays of two the 2D modality comes first.
class BimodalNetwork {
 public:
  /// Numbers of the layers, by modality.
  static constexpr std::array<std::size_t, 2> kEncode = {0, 1};  ///< visible → hidden
  static constexpr std::array<std::size_t, 2> kShare = {2, 3};   ///< hidden → shared
  static constexpr std::array<std::size_t, 2> kUnshare = {4, 5};
  static constexpr std::array<std::size_t, 2> kDecode = {6, 7};

  /// All values of a mini-batch.
  struct Pass {
    Pass(Device& device, const BimodalShape& shape, std::size_t rows);
    std::array<Matrix, 2> input, hidden, unshared, output;
    Matrix shared;
  };

  /// @param start the layers by their numbers
  BimodalNetwork(Device& device, const BimodalShape& shape, const std::vector<DenseLayer>& start);

  const BimodalShape& shape() const { return shape_; }
  /// From pass.input to pass.output.
  void forward(Pass& pass) const;
  /// The gradient of ½ Σ_m weight[m] · ‖output − target‖² / rows, after forward().
  /// @param errors like the pass; its contents are lost
  void differentiate(const Pass& pass, const std::array<Matrix, 2>& target,
                     const std::array<float, 2>& weight, Pass& errors);
  DenseNetwork& layers() { return layers_; }
  Device& device() const { return layers_.parameters().device(); }

 private:
  BimodalShape shape_;
  DenseNetwork layers_;
};

}  // namespace mcdbn
