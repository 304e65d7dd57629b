#pragma once

#include <cstddef>

#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// How the network draws where it is not asked otherwise (Algorithm 5; SamplingRule). Fine-tuning
/// sets its own.
struct RegenerationSettings {
  std::size_t gibbs_steps = 1, mrbm_gibbs_steps = 0;
  bool sampled = false;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(
        Setting{"gibbs-steps", within(0, 1000), "steps",
                "without fine-tuning: Gibbs steps (k) of the decoder in each frame of a sample; 0: "
                "mean field"},
        self.gibbs_steps);
    visit(
        Setting{"mrbm-gibbs-steps", within(0, 1000), "steps",
                "without fine-tuning: Gibbs steps (k) of the chain that infers each sample's code; "
                "0: all samples share the mean-field code"},
        self.mrbm_gibbs_steps);
    visit(
        Setting{
            "sampled", on_or_off(), "",
            "without fine-tuning: draw a single answer, too; off: take the mean field, which is "
            "more exact"},
        self.sampled);
  }
};

}  // namespace mcdbn
