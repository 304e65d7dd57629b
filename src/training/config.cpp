#include "mcdbn/training/config.hpp"

#include <fmt/format.h>

#include "mcdbn/errors.hpp"

namespace mcdbn {

TrainingConfig TrainingConfig::greedy() {
  TrainingConfig config;
  config.order = 5;
  config.layers = 2;
  config.hidden = config.mrbm_hidden = 300;
  config.gaussian.epochs = 100;
  config.binary.epochs = 50;
  config.mrbm.rate = 1e-3;
  config.mrbm.epochs = 30;
  config.joint.steps = 0;
  return config;
}

TrainingConfig TrainingConfig::paper() {
  TrainingConfig config = greedy();
  const CdSettings table2{.gibbs_steps = 5,
                          .rate = 0.1,
                          .rate_A = 0.1,
                          .rate_B = 0.1,
                          .momentum = 0.9,
                          .momentum_from_epoch = 0,
                          .weight_decay = 0.0,
                          .initial_deviation = 1.0,
                          .epochs = 100};
  config.gaussian = table2;
  config.binary = table2;
  config.mrbm.rate = 0.1;
  config.mrbm.initial_deviation = 1.0;
  config.mrbm_hidden = 150;
  config.look_ahead = 0;
  config.least_batches = 1;
  return config;
}

void TrainingConfig::validate() const {
  // Counts that nothing works without; histories (order, look-ahead) may be 0.
  const auto positive = [](const std::string& name, auto value) {
    if (!(value > 0)) throw ConfigError(fmt::format("{} must be above 0, not {}", name, value));
  };
  const auto share = [](const std::string& name, double value) {
    if (!(value >= 0 && value < 1))
      throw ConfigError(fmt::format("{} must be at least 0 and below 1, not {}", name, value));
  };
  positive("fps", fps);
  positive("phases", phases);
  positive("hidden", hidden);
  positive("layers", layers);
  positive("mrbm-hidden", mrbm_hidden);
  positive("batch", batch);
  positive("least-batches", least_batches);
  const auto contrastive_divergence = [&](const std::string& kind, const CdSettings& settings) {
    positive(kind + ".gibbs-steps", settings.gibbs_steps);
    positive(kind + ".rate", settings.rate);
    positive(kind + ".epochs", settings.epochs);
    share(kind + ".momentum", settings.momentum);
  };
  contrastive_divergence("gaussian", gaussian);
  contrastive_divergence("binary", binary);
  positive("mrbm.rate", mrbm.rate);
  positive("mrbm.mean-field-steps", mrbm.mean_field_steps);
  positive("mrbm.epochs", mrbm.epochs);
  positive("joint.windows", joint.windows);
  positive("joint.rate", joint.rate);
  positive("joint.mean-field-steps", joint.mean_field_steps);
  positive("augment.views", augment.views);
  if (joint.window_frames < 2) throw ConfigError("joint.window-frames must be at least 2");
  share("joint.dropout", joint.dropout);
  share("joint.average", joint.average);
  positive("camera.fov", camera.field_of_view_deg);
}

}  // namespace mcdbn
