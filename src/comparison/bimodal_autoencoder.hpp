#pragma once

#include <memory>

#include "comparison/baseline.hpp"
#include "comparison/dense_network.hpp"
#include "mcdbn/base/settings.hpp"
#include "mcdbn/device/device.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {

/// Chosen by CMU's training walkers, one of them held out (docs/baselines.md).
struct BimodalAutoencoderSettings {
  std::size_t track_hidden = 256, pose_hidden = 128, shared = 256;
  std::size_t pretraining_epochs = 20;
  double pretraining_rate = 1e-3;
  std::size_t epochs = 20;
  std::size_t least_batches = 40;
  std::size_t batch = 99;
  double rate = 1e-3;
  double weight_decay = 3.0;
  double pose_weight = 1.0;
  std::uint64_t seed = 1;

  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"track-hidden", size_limits::kUnits, "units",
                  "size of the 2D modality's own layer"},
          self.track_hidden);
    visit(
        Setting{"pose-hidden", size_limits::kUnits, "units", "size of the 3D modality's own layer"},
        self.pose_hidden);
    visit(Setting{"shared", size_limits::kUnits, "units", "size of the layer that both share"},
          self.shared);
    visit(Setting{"pretraining-epochs", within(0, 1e7), "epochs",
                  "epochs of CD-1 for each RBM that a layer starts as; 0 starts from random "
                  "weights"},
          self.pretraining_epochs);
    visit(Setting{"pretraining-rate", above(0, 100), "", "learning rate of the RBMs"},
          self.pretraining_rate);
    visit(Setting{"epochs", within(1, 1e7), "epochs", "epochs of back-propagation"}, self.epochs);
    visit(Setting{"least-batches", within(1, 1e6), "mini-batches",
                  "least mini-batches in an epoch; a small data set is visited several times"},
          self.least_batches);
    visit(Setting{"batch", within(3, 1e5), "windows",
                  "size of a mini-batch: a third with both modalities, a third with each alone"},
          self.batch);
    visit(Setting{"rate", above(0, 100), "", "Adam's rate; falls in a line over the second half"},
          self.rate);
    visit(
        Setting{
            "weight-decay", within(0, 1000), "",
            "decoupled decay of the weights, times the rate: what generalizes to unseen people"},
        self.weight_decay);
    visit(Setting{"pose-weight", above(0, 1e6), "",
                  "weight of a 3D value's squared error; a 2D value's is 1, and there are several "
                  "times as many 2D values"},
          self.pose_weight);
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
  }
};

/// The bimodal deep autoencoder of Ngiam et al. (2011), the paper's [13]: a window of 2D
/// (track_window.hpp) and the pose each have a layer of sigmoid units, and those share one; from it
/// both are decoded. Layers start as RBMs. Back-propagation then sees a third of its examples with
/// both modalities, a third with each alone (the other is zero, its mean), and has to give both
/// back: so the pose can be inferred from the track.
class BimodalAutoencoder : public Baseline {
 public:
  explicit BimodalAutoencoder(Device& device, const BimodalAutoencoderSettings& settings = {});
  ~BimodalAutoencoder() override;

  std::string name() const override { return "bimodal_autoencoder"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

  /// In the order of bimodal_network.hpp. Empty before fit().
  std::vector<DenseLayer> layers() const;

 private:
  Device* device_;
  BimodalAutoencoderSettings settings_;
  Eigen::Index track_dimension_ = 0;
  std::unique_ptr<class BimodalNetwork> network_;
};

}  // namespace mcdbn
