#pragma once

#include <memory>

#include "comparison/baseline.hpp"
#include "mcdbn/base/settings.hpp"
#include "mcdbn/device/device.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {

/// Chosen by CMU's training walkers, one of them held out (docs/baselines.md).
struct MultimodalDbmSettings {
  std::size_t track_hidden = 256, pose_hidden = 128, joint = 128;
  std::size_t pretraining_epochs = 5;
  std::size_t epochs = 30;
  std::size_t least_batches = 40;
  std::size_t batch = 100;
  double pretraining_rate = 1e-3, rate = 1e-3;
  double momentum = 0.5;
  double weight_decay = 2e-4;
  std::size_t mean_field_steps = 5;
  std::size_t gibbs_sweeps = 2;
  std::size_t inference_steps = 10;
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
    visit(Setting{"joint", size_limits::kUnits, "units", "size of the layer above both"},
          self.joint);
    visit(Setting{"pretraining-epochs", within(0, 1e7), "epochs",
                  "epochs of CD-1 for each modality's layer, and then for the joint one"},
          self.pretraining_epochs);
    visit(Setting{"epochs", within(0, 1e7), "epochs", "epochs of joint training"}, self.epochs);
    visit(Setting{"least-batches", within(1, 1e6), "mini-batches",
                  "least mini-batches in an epoch; a small data set is visited several times"},
          self.least_batches);
    visit(Setting{"batch", within(1, 1e5), "windows", "size of a mini-batch, and number of chains"},
          self.batch);
    visit(Setting{"pretraining-rate", above(0, 100), "",
                  "learning rate of the modalities' own layers; the joint one's is ten times that"},
          self.pretraining_rate);
    visit(Setting{"rate", above(0, 100), "",
                  "learning rate of joint training; falls in a line to a fiftieth"},
          self.rate);
    visit(Setting{"momentum", share_below_one(), "",
                  "share of a step that goes on in the next: averages out sampling noise"},
          self.momentum);
    visit(Setting{"weight-decay", within(0, 1000), "",
                  "decay of the weights, times the rate: keeps chains moving"},
          self.weight_decay);
    visit(Setting{"mean-field-steps", size_limits::kMeanFieldSteps, "steps",
                  "mean-field steps of the data's hidden units"},
          self.mean_field_steps);
    // Each has random numbers of its own.
    visit(Setting{"gibbs-sweeps", within(1, 1000), "sweeps",
                  "Gibbs sweeps of the chains in each mini-batch: with more they are nearer to the "
                  "model"},
          self.gibbs_sweeps);
    visit(Setting{"inference-steps", size_limits::kMeanFieldSteps, "steps",
                  "mean-field steps by which the absent pose is inferred"},
          self.inference_steps);
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
  }
};

/// The multimodal deep Boltzmann machine of Srivastava and Salakhutdinov (2012, 2014), the paper's
/// [15], on a window of 2D (track_window.hpp) and the pose (dbm_machine.hpp). Layers are trained
/// greedily by CD-1, then all jointly: the data's statistics by mean field, the model's by
/// persistent chains. The pose is inferred by mean field with the window clamped.
class MultimodalDbm : public Baseline {
 public:
  explicit MultimodalDbm(Device& device, const MultimodalDbmSettings& settings = {});
  ~MultimodalDbm() override;

  std::string name() const override { return "multimodal_dbm"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

 private:
  Device* device_;
  MultimodalDbmSettings settings_;
  Eigen::Index track_dimension_ = 0;
  std::unique_ptr<class DbmMachine> machine_;
};

}  // namespace mcdbn
