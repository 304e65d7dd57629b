#pragma once

#include <cstddef>
#include <cstdint>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {

/// How one kind of CRBM layer is trained (Algorithm 2, eq 36 to 41).
struct CdSettings {
  std::size_t gibbs_steps = 5;
  double rate = 1e-3, rate_A = 1e-5, rate_B = 1e-3;
  double momentum = 0.9;
  std::size_t momentum_from_epoch = 5;
  double weight_decay = 2e-4;
  double initial_deviation = 0.01;
  double history_noise = 0.0;
  std::size_t epochs = 3;
  bool persistent = false;
  double fast_rate = 0.0;
  bool sample_visible = false;
  double sparsity_target = 0.1, sparsity_strength = 0.0;
  double l1 = 0.0;
  bool adam = false;
  double final_rate = 1.0;
  bool cosine = false;
  double deviation_rate = 0.0;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    // So many steps, and some more, have random numbers of their own (greedy_schedule.cpp).
    visit(
        Setting{
            "gibbs-steps", within(1, 1000), "steps",
            "k of CD-k: more steps follow the likelihood's gradient more closely and take longer"},
        self.gibbs_steps);
    visit(Setting{"rate", above(0, 100), "", "learning rate of W and the biases"}, self.rate);
    visit(Setting{"rate-A", within(0, 100), "",
                  "learning rate of A (history to visible); small, else A alone explains the data"},
          self.rate_A);
    visit(Setting{"rate-B", within(0, 100), "", "learning rate of B (history to hidden)"},
          self.rate_B);
    visit(Setting{"momentum", share_below_one(), "",
                  "share of the last step that is added to the next; averages out sampling noise"},
          self.momentum);
    visit(Setting{"momentum-from-epoch", within(0, 1e7), "epochs",
                  "first epochs without momentum, while the gradient still changes direction; does "
                  "not affect Adam"},
          self.momentum_from_epoch);
    visit(Setting{"weight-decay", within(0, 1000), "",
                  "decay of W, A and B, times the rate: keeps weights of little effect small"},
          self.weight_decay);
    visit(Setting{"initial-deviation", within(0, 100), "",
                  "standard deviation of the first weights; not used before fine-tuning, which "
                  "sets its own"},
          self.initial_deviation);
    visit(Setting{"history-noise", within(0, 100), "",
                  "standard deviation of noise on the history, new in every mini-batch: for "
                  "free-running generation, which has to recover from its own errors"},
          self.history_noise);
    visit(
        Setting{
            "epochs", within(1, 1e7), "epochs",
            "passes over the data; the default without fine-tuning is 100, of binary layers 50"},
        self.epochs);
    visit(Setting{"persistent", on_or_off(), "",
                  "persistent contrastive divergence: chains continue from one mini-batch to the "
                  "next, each under the history of its window"},
          self.persistent);
    visit(
        Setting{"fast-rate", within(0, 100), "",
                "learning rate of fast weights, which make persistent chains mix faster; 0: none"},
        self.fast_rate);
    visit(
        Setting{
            "sample-visible", on_or_off(), "",
            "draw the visible units in the chain, as the model defines it; off: use their means"},
        self.sample_visible);
    visit(Setting{"sparsity-target", between(0, 1), "",
                  "how often a hidden unit should be on; needs sparsity-strength"},
          self.sparsity_target);
    visit(Setting{"sparsity-strength", within(0, 1000), "",
                  "how strongly hidden units are pulled to that target, which keeps all of them in "
                  "use; 0: not at all"},
          self.sparsity_strength);
    visit(Setting{"l1", within(0, 1000), "",
                  "L1 penalty on W, A and B, times the rate: leaves few weights large"},
          self.l1);
    visit(
        Setting{
            "adam", on_or_off(), "",
            "Adam, which adapts the rate of each weight, with momentum as its first decay (β1)"},
        self.adam);
    visit(
        Setting{"final-rate", within(0, 1), "",
                "learning rates fall to this share of themselves by the last epoch; 1: they stay"},
        self.final_rate);
    visit(Setting{"cosine", on_or_off(), "", "learning rates fall along a cosine; off: linearly"},
          self.cosine);
    visit(Setting{"deviation-rate", within(0, 100), "",
                  "learning rate of the Gaussian units' deviation σ; order 0 only; 0: σ is fixed"},
          self.deviation_rate);
  }
};

/// How the MRBM is trained: MinVI (eq 42) by multi-prediction or by CD-PercLoss, or the joint
/// likelihood by contrastive divergence.
struct MrbmSettings {
  double rate = 3e-4;
  double weight_decay = 0.0;
  double initial_deviation = 0.01;
  std::size_t mean_field_steps = 5;
  std::size_t epochs = 1;
  bool joint_likelihood = false, perceptron_loss = false;
  std::size_t gibbs_steps = 1;
  bool persistent = false, sample_visible = false;
  bool adam = true;
  double momentum = 0.9;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(
        Setting{"rate", above(0, 100), "",
                "learning rate; falls linearly to a fiftieth over the second half of the training"},
        self.rate);
    visit(
        Setting{
            "weight-decay", within(0, 1000), "",
            "decoupled decay of the weights, times the rate: keeps those of little effect small"},
        self.weight_decay);
    visit(Setting{"initial-deviation", within(0, 100), "",
                  "standard deviation of the first weights; not used before fine-tuning, which "
                  "sets its own"},
          self.initial_deviation);
    visit(Setting{"mean-field-steps", size_limits::kMeanFieldSteps, "steps",
                  "unrolled mean-field steps (eq 32 and 33): more come closer to the fixed point"},
          self.mean_field_steps);
    visit(Setting{"epochs", within(1, 1e7), "epochs",
                  "passes over the codes; the default without fine-tuning is 30"},
          self.epochs);
    visit(Setting{"joint-likelihood", on_or_off(), "",
                  "maximize the joint likelihood by contrastive divergence, in place of MinVI"},
          self.joint_likelihood);
    visit(
        Setting{"perceptron-loss", on_or_off(), "",
                "MinVI by CD-PercLoss in place of multi-prediction; without joint-likelihood only"},
        self.perceptron_loss);
    visit(Setting{"gibbs-steps", within(1, 1000), "steps",
                  "k of the Gibbs chains of joint-likelihood and perceptron-loss"},
          self.gibbs_steps);
    visit(Setting{"persistent", on_or_off(), "",
                  "with joint-likelihood: chains continue from one mini-batch to the next"},
          self.persistent);
    visit(Setting{"sample-visible", on_or_off(), "",
                  "draw the codes in those chains, as the model defines it; off: use their means"},
          self.sample_visible);
    visit(Setting{"adam", on_or_off(), "", "Adam; off: gradient descent with momentum"}, self.adam);
    visit(Setting{"momentum", share_below_one(), "",
                  "share of the last step that is added to the next; Adam's first decay (β1)"},
          self.momentum);
  }
};

/// Fine-tuning: MinVI through the whole stack (fine_tuning.hpp).
struct FineTuningSettings {
  std::size_t steps = 3000;
  std::size_t view_uses = 0;
  bool from_greedy = true;
  std::size_t windows = 48;
  double people_power = 0.5;
  std::size_t window_frames = 20, settle_frames = 4;
  double rate = 2e-3;
  /// Of a training that starts from a model: what it knows is kept (docs/corpus.md).
  static constexpr double kRateFromModel = 5e-4;
  double weight_decay = 1.0;
  double dropout = 0.0;
  double average = 0.995;
  double reverse = 0.1;
  std::size_t mean_field_steps = 2;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"steps", within(0, 1e9), "mini-batches",
                  "mini-batches of fine-tuning; 0: no fine-tuning"},
          self.steps);
    // 3,000 mini-batches learn six views of 60 CMU clips by heart.
    visit(
        Setting{
            "view-uses", within(0, 1e6), "windows",
            "windows drawn from an augmented view, on average, before a new view replaces it; 0: "
            "all views are made before training; with more than about two hours of clips, 0 is 16"},
        self.view_uses);
    visit(Setting{"from-greedy", on_or_off(), "",
                  "train the greedy stages first, on the same views and from weights of the size "
                  "that fine-tuning needs; off: start from random weights"},
          self.from_greedy);
    visit(Setting{"windows", within(1, 1e5), "windows", "windows in a mini-batch"}, self.windows);
    visit(Setting{"people-power", within(0, 1), "",
                  "a person (with actions given, a person in an action) is drawn with probability "
                  "proportional to frames^power; 1: all frames alike, 0: all people alike"},
          self.people_power);
    // The loss counts steps from frame to frame, too.
    visit(Setting{"window-frames", within(2, 1000), "frames",
                  "frames of a window that the loss counts"},
          self.window_frames);
    visit(
        Setting{
            "settle-frames", within(0, 1000), "frames",
            "free-running frames before those that the loss counts, so that these start from the "
            "network's own errors"},
        self.settle_frames);
    visit(Setting{"rate", above(0, 100), "",
                  "Adam's learning rate; falls along a cosine to a fiftieth"},
          self.rate);
    visit(
        Setting{
            "weight-decay", within(0, 1000), "",
            "decoupled decay of the weights, times the rate: keeps those of little effect small"},
        self.weight_decay);
    visit(Setting{"dropout", share_below_one(), "",
                  "share of hidden units that are left out; the same ones throughout a window"},
          self.dropout);
    visit(Setting{"average", share_below_one(), "",
                  "share of the parameters' moving average that each step keeps; the average is "
                  "the result"},
          self.average);
    visit(Setting{"reverse", within(0, 1000), "",
                  "weight of the loss in the other direction, 2D from 3D"},
          self.reverse);
    visit(Setting{"mean-field-steps", size_limits::kMeanFieldSteps, "steps",
                  "unrolled mean-field steps (eq 32 and 33), in training and in the model"},
          self.mean_field_steps);
  }
};

/// How the network draws where it is not asked otherwise (Algorithm 5; SamplingRule). Fine-tuning
/// sets its own.
struct RegenerationSettings {
  std::size_t gibbs_steps = 1, mrbm_gibbs_steps = 0;
  bool sampled = false;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"gibbs-steps", within(0, 1000), "steps",
                  "Gibbs steps (k) of the decoder in each frame of a sample; 0: mean field"},
          self.gibbs_steps);
    visit(Setting{"mrbm-gibbs-steps", within(0, 1000), "steps",
                  "Gibbs steps (k) of the chain that infers each sample's code; 0: all samples "
                  "share the mean-field code"},
          self.mrbm_gibbs_steps);
    visit(Setting{"sampled", on_or_off(), "",
                  "draw a single answer, too; off: take the mean field, which is more exact"},
          self.sampled);
  }
};

/// The network's size and how it is learnt, whatever the data are: the paper's Table 2 and section
/// V, and what it leaves out.
struct LearningSettings {
  std::uint64_t seed = 1;
  /// One CRBM that sees 10 frames of history in each CDBN, where the paper has two of order 5: the
  /// same frames in all, at a third of the cost, so that the layer can be wider and trained longer.
  std::size_t order = 10;
  std::size_t hidden = 768;
  std::size_t layers = 1;
  std::size_t mrbm_hidden = 512;
  std::size_t look_ahead = 5;
  std::size_t batch = 100;
  /// The rates and epochs that suit an hour of motion would stop long before a minute's was learnt.
  std::size_t least_batches = 40;
  double people_power = 1;

  CdSettings gaussian;
  CdSettings binary{.gibbs_steps = 1, .rate = 1e-2, .rate_A = 1e-3, .rate_B = 1e-3};
  MrbmSettings mrbm;
  FineTuningSettings fine_tuning;
  RegenerationSettings regeneration;

  /// The paper's architecture for the greedy stages alone, at rates and for epochs that train it:
  /// two CRBMs of order 5 and 300 units in each CDBN.
  static LearningSettings greedy();
  /// The paper's own figures (Table 2, section V.C): rate 0.1 and momentum 0.9 throughout, weights
  /// from N(0, 1), MRBM of 150, no look-ahead, k = 5 sampled steps in training and 3 in
  /// regeneration. Diverges, which the guard reports.
  static LearningSettings paper();
  /// The nearest to it that trains: rates and first weights that do not diverge, all else the same.
  static LearningSettings paper_stable();
  /// For free-running generation: the greedy stages with one layer a CDBN, by CD-1 with noise on
  /// the histories, falling rates and all people alike (docs/generation.md).
  static LearningSettings generation();
  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
    visit(Setting{"order", size_limits::kHistory, "frames",
                  "frames of history that every CRBM sees (N)"},
          self.order);
    visit(Setting{"hidden", size_limits::kUnits, "units", "hidden units of every CRBM"},
          self.hidden);
    visit(Setting{"layers", size_limits::kLayers, "CRBMs",
                  "CRBMs in each CDBN; each learns the code of the one below"},
          self.layers);
    visit(Setting{"mrbm-hidden", size_limits::kUnits, "units", "hidden units of the MRBM"},
          self.mrbm_hidden);
    visit(Setting{"look-ahead", size_limits::kLookAhead, "frames",
                  "the 3D code of frame t is inferred from the 2D code of frame t + look-ahead; 0: "
                  "causal, as in the paper"},
          self.look_ahead);
    visit(
        Setting{"batch", within(1, 1e5), "windows", "windows in a mini-batch of the greedy stages"},
        self.batch);
    visit(Setting{"least-batches", within(1, 1e6), "mini-batches",
                  "least mini-batches in an epoch; a small data set is visited several times"},
          self.least_batches);
    visit(Setting{"people-power", within(0, 1), "",
                  "greedy stages: a person is drawn with probability proportional to frames^power; "
                  "1: all frames alike, 0: all people alike"},
          self.people_power);
    visit_group("gaussian", self.gaussian, visit);
    visit_group("binary", self.binary, visit);
    visit_group("mrbm", self.mrbm, visit);
    visit_group("fine-tuning", self.fine_tuning, visit);
    visit_group("regeneration", self.regeneration, visit);
  }
};

}  // namespace mcdbn
