#pragma once

#include <algorithm>
#include <vector>

#include "device/gemm.hpp"
#include "device/optimizer.hpp"
#include "learning/minibatch.hpp"

namespace mcdbn {

/// One layer on the host: output = f(input·W + b).
struct DenseLayer {
  MatrixF W;  ///< [inputs x outputs]
  MatrixF b;  ///< [1 x outputs]
};

/// Variance 1 / (3 · inputs), as PyTorch starts its linear layers; b is zero.
/// @param rows of W, where they are more than the inputs, as some of those are padding
DenseLayer random_dense_layer(std::size_t inputs, std::size_t rows, std::size_t outputs,
                              const RandomKey& key);

/// Layers on the device that learn by Adam. How they are connected is the user's: each goes forward
/// and backward by itself.
class DenseNetwork {
 public:
  DenseNetwork(Device& device, const std::vector<DenseLayer>& start);

  /// output = f(input·W + b), or with `add` f(output + input·W + b).
  void forward(std::size_t layer, const Rows& input, const Rows& output,
               Activation activation = Activation::none, bool add = false) const;

  /// The activation between a layer's input and the error that is wanted there.
  struct Slope {
    Activation gradient = Activation::none;
    const Rows* units = nullptr;  ///< values of the activation whose gradient it is
    float scale = 1.0F;
    bool add = false;  ///< to the error that is there already, before the gradient
  };
  /// The error at the layer's output → the error at its input.
  void backward(std::size_t layer, const Rows& error, const Rows& error_below,
                const Slope& slope) const;
  /// The layer's gradient: inputᵀ·error, and the sum of the errors.
  void differentiate(std::size_t layer, const Rows& input, const Rows& error);
  /// All layers by their gradients; biases do not decay.
  void update(const UpdateRule& rule);

  const Parameters& parameters() const { return optimizer_.parameters(); }
  /// Gradients of each layer from the last differentiate().
  std::vector<DenseLayer> gradients() const;
  std::vector<DenseLayer> to_host() const;

 private:
  struct Layer {
    Matrix W, b, gradient_W, gradient_b, W_transposed;
  };
  Optimizer optimizer_;
  std::vector<Layer> layers_;
};

/// Epochs of shuffled mini-batches, at a rate that falls in a line over the second half.
/// @param settings of `epochs` and `rate`  @param shuffles its step is the epoch's number
/// @param trainer whose step() takes rows' numbers, the first of the mini-batch, and the rate
template <typename Trainer, typename Settings>
void train_epochs(Trainer& trainer, MinibatchSchedule& schedule, const Settings& settings,
                  RandomKey shuffles) {
  const std::size_t batches = schedule.batch_count(), all = settings.epochs * batches;
  for (std::size_t i = 0; i < all; ++i) {
    shuffles.step = static_cast<std::uint32_t>(i / batches);
    if (i % batches == 0) schedule.shuffle(shuffles);
    const double progress = static_cast<double>(i) / static_cast<double>(all);
    trainer.step(schedule.index(), schedule.first_of(i % batches),
                 settings.rate * std::min(1.0, 2.0 - 1.98 * progress));
  }
}

}  // namespace mcdbn
