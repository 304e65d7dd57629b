#pragma once

#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn::test {

/// Settings of a whole training, both stages, that takes a moment.
inline TrainingConfig tiny_training_config() {
  TrainingConfig config;
  config.seed = 19;
  config.hidden = 8;
  config.mrbm_hidden = 6;
  config.order = 2;
  config.look_ahead = 2;
  config.batch = 20;
  config.least_batches = 2;
  config.gaussian.epochs = config.mrbm.epochs = 2;
  config.gaussian.gibbs_steps = 1;
  config.mrbm.mean_field_steps = 4;
  config.augment.views = 2;
  config.fine_tuning.steps = 3;
  config.fine_tuning.windows = 4;
  config.fine_tuning.window_frames = 4;
  config.fine_tuning.mean_field_steps = 2;
  return config;
}

}  // namespace mcdbn::test
