#pragma once

#include <cstddef>

#include "mcdbn/base/settings.hpp"

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
    // At most 1000: each step has phases of random numbers of its own (base/random_phases.hpp).
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
    visit(
        Setting{"initial-deviation", within(0, 100), "", "standard deviation of the first weights"},
        self.initial_deviation);
    visit(Setting{"history-noise", within(0, 100), "",
                  "standard deviation of noise on the history, new in every mini-batch: for "
                  "free-running generation, which has to recover from its own errors"},
          self.history_noise);
    visit(Setting{"epochs", within(1, 1e7), "epochs", "passes over the data"}, self.epochs);
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

}  // namespace mcdbn
