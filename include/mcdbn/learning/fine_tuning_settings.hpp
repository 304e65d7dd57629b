#pragma once

#include <cstddef>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {

/// Fine-tuning: MinVI through the whole stack (fine_tuning.hpp).
struct FineTuningSettings {
  std::size_t steps = 3000;
  std::size_t view_uses = 0;
  bool from_greedy = true;
  std::size_t windows = 48;
  double people_power = 0.5;
  std::size_t window_frames = 20, settle_frames = 4;
  double rate = 2e-3;
  /// Rate of a training that starts from a model: low, to keep what it knows (docs/corpus.md).
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

}  // namespace mcdbn
