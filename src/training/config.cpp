#include "mcdbn/training/config.hpp"

namespace mcdbn {

TrainingConfig TrainingConfig::paper() {
  TrainingConfig config;
  const CdSettings table2{.gibbs_steps = 5,
                          .rate = 0.1,
                          .rate_A = 0.1,
                          .rate_B = 0.1,
                          .momentum = 0.9,
                          .momentum_from_epoch = 0,
                          .weight_decay = 0.0,
                          .initial_deviation = 1.0};
  config.gaussian = table2;
  config.binary = table2;
  config.mrbm.rate = 0.1;
  config.mrbm.initial_deviation = 1.0;
  config.mrbm_hidden = 150;
  config.look_ahead = 0;
  return config;
}

}  // namespace mcdbn
