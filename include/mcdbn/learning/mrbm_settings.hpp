#pragma once

#include <cstddef>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {

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
    visit(
        Setting{"initial-deviation", within(0, 100), "", "standard deviation of the first weights"},
        self.initial_deviation);
    visit(Setting{"mean-field-steps", size_limits::kMeanFieldSteps, "steps",
                  "unrolled mean-field steps (eq 32 and 33): more come closer to the fixed point"},
          self.mean_field_steps);
    visit(Setting{"epochs", within(1, 1e7), "epochs", "passes over the data"}, self.epochs);
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

}  // namespace mcdbn
