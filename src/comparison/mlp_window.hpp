#pragma once

#include "comparison/baseline.hpp"
#include "comparison/dense_network.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// A perceptron with two hidden layers of rectified units on 11 frames of 2D
/// (track_window.hpp), trained on the device by Adam with drop-out on the squared error: what
/// anybody would try first today.
class MlpWindow : public Baseline {
 public:
  struct Settings {
    std::size_t hidden = 512;
    std::size_t epochs = 40;
    std::size_t least_batches = 40;  ///< an epoch, as in TrainingConfig
    std::size_t batch = 100;
    double rate = 1e-3;  ///< falls in a line over the second half
    double dropout = 0.3;
    double weight_decay = 2.0;  ///< decoupled, times the rate: what generalizes to unseen people
    std::uint64_t seed = 1;

    /// For many augmented views of each clip: fewer rounds of larger mini-batches.
    static Settings for_views() {
      Settings settings;
      settings.epochs = 6;
      settings.batch = 500;
      settings.weight_decay = 1.0;
      return settings;
    }
  };
  explicit MlpWindow(Device& device) : MlpWindow(device, Settings()) {}
  MlpWindow(Device& device, const Settings& settings) : device_(&device), settings_(settings) {}

  std::string name() const override { return "mlp_window"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;
  bool learns_from_views() const override { return true; }

  /// The first layer's input is as wide as the device pads it. Empty before fit().
  const std::vector<DenseLayer>& layers() const { return layers_; }

 private:
  Device* device_;
  Settings settings_;
  Eigen::Index track_dimension_ = 0;
  std::vector<DenseLayer> layers_;
};

}  // namespace mcdbn
