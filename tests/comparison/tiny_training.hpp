#pragma once

#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn::test {

/// A network whose training takes no time.
inline TrainingConfig tiny_training() {
  TrainingConfig config = TrainingConfig::greedy();
  config.hidden = config.mrbm_hidden = 6;
  config.layers = 1;
  config.order = 2;
  config.least_batches = 1;
  config.gaussian.epochs = config.mrbm.epochs = 2;
  return config;
}

}  // namespace mcdbn::test
