#include "comparison/bimodal_network.hpp"

#include "device/pointwise.hpp"

namespace mcdbn {

BimodalNetwork::Pass::Pass(Device& device, const BimodalShape& shape, std::size_t rows)
    : shared(device, rows, shape.top) {
  for (std::size_t m = 0; m < 2; ++m) {
    input[m] = Matrix(device, rows, shape.visible[m]);
    hidden[m] = Matrix(device, rows, shape.hidden[m]);
    unshared[m] = Matrix::like(hidden[m]);
    output[m] = Matrix::like(input[m]);
  }
}

BimodalNetwork::BimodalNetwork(Device& device, const BimodalShape& shape,
                               const std::vector<DenseLayer>& start)
    : shape_(shape), layers_(device, start) {}

void BimodalNetwork::forward(Pass& pass) const {
  for (std::size_t m = 0; m < 2; ++m)
    layers_.forward(kEncode[m], pass.input[m], pass.hidden[m], Activation::sigmoid);
  layers_.forward(kShare[0], pass.hidden[0], pass.shared);
  layers_.forward(kShare[1], pass.hidden[1], pass.shared, Activation::sigmoid, true);
  for (std::size_t m = 0; m < 2; ++m) {
    layers_.forward(kUnshare[m], pass.shared, pass.unshared[m], Activation::sigmoid);
    layers_.forward(kDecode[m], pass.unshared[m], pass.output[m]);
  }
}

void BimodalNetwork::differentiate(const Pass& pass, const std::array<Matrix, 2>& target,
                                   const std::array<float, 2>& weight, Pass& errors) {
  const auto slope_of = [](const Rows& units, bool add = false) {
    return DenseNetwork::Slope{
        .gradient = Activation::sigmoid_gradient, .units = &units, .add = add};
  };
  const Rows shared = pass.shared;
  for (std::size_t m = 0; m < 2; ++m) {
    const Rows unshared = pass.unshared[m];
    scaled_difference(pass.output[m], target[m], weight[m] / static_cast<float>(target[m].rows()),
                      errors.output[m]);
    layers_.differentiate(kDecode[m], unshared, errors.output[m]);
    layers_.backward(kDecode[m], errors.output[m], errors.unshared[m], slope_of(unshared));
    layers_.differentiate(kUnshare[m], shared, errors.unshared[m]);
  }
  layers_.backward(kUnshare[0], errors.unshared[0], errors.shared, {});
  layers_.backward(kUnshare[1], errors.unshared[1], errors.shared, slope_of(shared, true));
  for (std::size_t m = 0; m < 2; ++m) {
    const Rows hidden = pass.hidden[m];
    layers_.differentiate(kShare[m], hidden, errors.shared);
    layers_.backward(kShare[m], errors.shared, errors.hidden[m], slope_of(hidden));
    layers_.differentiate(kEncode[m], pass.input[m], errors.hidden[m]);
  }
}

}  // namespace mcdbn
