#pragma once

#include "device/optimizer.hpp"
#include "learning/learning_rule.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// What rules that learn an MRBM from Gibbs chains share: a mini-batch of every modality, chains
/// that start from it, and the gradient of the free energies' difference. The rules are
/// JointLikelihood and PerceptronLoss.
///
/// Hidden units are sampled, visible ones are means unless the settings say otherwise, and the last
/// hidden step keeps probabilities, as in contrastive divergence. Phases of the draws: the step for
/// hidden units, kVisibleUnits + step · modalities + modality for visible ones. Products are
/// launched one after the other.
class MrbmChains : public LearningRule {
 public:
  std::size_t loss_count() const override { return mrbm_.modality_count(); }
  /// One mini-batch by the rule that the settings specify. Adds to `losses` the mean squared error
  /// of a unit between the data and the chain's end, in slot m that of the modality m.
  /// @param visible the codes of each modality, indexed  @throws ShapeError
  void learn(std::span<const Rows> visible, const LearningStep& step,
             LossAccumulator& losses) override;

  void visit_state(TrainingState& state) override { optimizer_.visit_state(state); }

  /// The gradient of the last step, downhill, where the optimizer is none; for tests.
  MrbmParameters gradients();

 protected:
  MrbmChains(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings, OptimizerKind optimizer);
  /// Room for what follows, but for the optimizer's.
  void make_matrices();

  /// One mini-batch of rows that were checked, with its update.
  virtual void run_minibatch(std::span<const Rows> visible, const LearningStep& step,
                             LossAccumulator& losses);
  /// Adds the gradients of a mini-batch whose data are in data_.
  virtual void add_gradients(const RandomKey& key, LossAccumulator& losses) = 0;

  /// p(h = 1 | data) and draws of it.
  void hidden_of_data(const RandomKey& key);
  /// `gibbs-steps` from hidden_sample_ on: the free modalities' units and hidden_ at the end; the
  /// other modalities stay the data. @param draw_last leaves draws of the last in hidden_sample_
  void run(std::span<const std::size_t> free, const RandomKey& key, bool draw_last = false);
  /// Σ over rows of weight · (−∂F/∂θ of the data, +∂F/∂θ at the chain's end), downhill.
  /// @param weights [batch x 1]
  void add_contrast(std::span<const std::size_t> free, const Matrix& weights);
  /// The data, but for the free modalities the chain's units.
  std::vector<Rows> units(std::span<const std::size_t> free) const;
  std::vector<Rows> data() const { return units({}); }

  Mrbm& mrbm_;
  MrbmSettings settings_;
  std::size_t batch_;
  std::vector<Matrix> data_, visible_;           // [batch x visible] of each modality
  Matrix hidden_data_, hidden_, hidden_sample_;  // [batch x hidden]
  Optimizer optimizer_;

 private:
  void add_side(const std::vector<Rows>& units, const Matrix& hidden, const Matrix& weights,
                float sign);

  std::optional<MrbmMatrices> gradient_;  // the optimizer's
  Matrix weighted_;                       // [batch x hidden]
};

}  // namespace mcdbn
