#include "mcdbn/learning/learning_settings.hpp"

namespace mcdbn {

LearningSettings LearningSettings::greedy() {
  LearningSettings settings;
  settings.order = 5;
  settings.layers = 2;
  settings.hidden = settings.mrbm_hidden = 300;
  settings.gaussian.epochs = 100;
  settings.binary.epochs = 50;
  settings.mrbm.rate = 1e-3;
  settings.mrbm.epochs = 30;
  settings.fine_tuning.steps = 0;
  return settings;
}

LearningSettings LearningSettings::paper() {
  LearningSettings settings = greedy();
  const CdSettings table2{.gibbs_steps = 5,
                          .rate = 0.1,
                          .rate_A = 0.1,
                          .rate_B = 0.1,
                          .momentum = 0.9,
                          .momentum_from_epoch = 0,
                          .weight_decay = 0.0,
                          .initial_deviation = 1.0,
                          .epochs = 100,
                          .sample_visible = true};
  settings.gaussian = table2;
  settings.binary = table2;
  settings.mrbm.rate = 0.1;
  settings.mrbm.initial_deviation = 1.0;
  settings.mrbm.adam = false;
  settings.mrbm_hidden = 150;
  settings.look_ahead = 0;
  settings.least_batches = 1;
  settings.regeneration = {.gibbs_steps = 3, .mrbm_gibbs_steps = 3, .sampled = true};
  return settings;
}

LearningSettings LearningSettings::paper_stable() {
  LearningSettings settings = paper();
  const LearningSettings usual = greedy();
  for (const auto layer : {&LearningSettings::gaussian, &LearningSettings::binary}) {
    CdSettings& own = settings.*layer;
    own.rate = (usual.*layer).rate;
    own.rate_A = (usual.*layer).rate_A;
    own.rate_B = (usual.*layer).rate_B;
    own.initial_deviation = (usual.*layer).initial_deviation;
  }
  // With momentum 0.9 a step counts ten times: an effective rate of 0.01.
  settings.mrbm.rate = 1e-3;
  settings.mrbm.initial_deviation = usual.mrbm.initial_deviation;
  settings.least_batches = usual.least_batches;
  return settings;
}

LearningSettings LearningSettings::generation() {
  LearningSettings settings = greedy();
  settings.order = 8;
  settings.hidden = 600;
  settings.layers = 1;
  settings.gaussian.gibbs_steps = 1;
  settings.gaussian.rate = settings.gaussian.rate_B = 3e-3;
  settings.gaussian.rate_A = 1e-4;
  settings.gaussian.history_noise = 1.0;
  settings.gaussian.epochs = 200;
  settings.gaussian.final_rate = 0.05;
  settings.gaussian.cosine = true;
  settings.people_power = 0;
  return settings;
}

}  // namespace mcdbn
