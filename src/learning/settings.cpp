#include "mcdbn/learning/settings.hpp"

#include <string>

#include "base/setting_checks.hpp"

namespace mcdbn {
namespace {

void validate_layer(const std::string& kind, const CdSettings& settings) {
  require_positive(kind + ".gibbs-steps", settings.gibbs_steps);
  require_positive(kind + ".rate", settings.rate);
  require_positive(kind + ".epochs", settings.epochs);
  require_share(kind + ".momentum", settings.momentum);
}

}  // namespace

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
                          .epochs = 100};
  settings.gaussian = table2;
  settings.binary = table2;
  settings.mrbm.rate = 0.1;
  settings.mrbm.initial_deviation = 1.0;
  settings.mrbm_hidden = 150;
  settings.look_ahead = 0;
  settings.least_batches = 1;
  return settings;
}

void LearningSettings::validate() const {
  // Counts that nothing works without; histories (order, look-ahead) may be 0.
  require_positive("hidden", hidden);
  require_positive("layers", layers);
  require_positive("mrbm-hidden", mrbm_hidden);
  require_positive("batch", batch);
  require_positive("least-batches", least_batches);
  validate_layer("gaussian", gaussian);
  validate_layer("binary", binary);
  require_positive("mrbm.rate", mrbm.rate);
  require_positive("mrbm.mean-field-steps", mrbm.mean_field_steps);
  require_positive("mrbm.epochs", mrbm.epochs);
  require_positive("fine-tuning.windows", fine_tuning.windows);
  require_positive("fine-tuning.rate", fine_tuning.rate);
  require_positive("fine-tuning.mean-field-steps", fine_tuning.mean_field_steps);
  if (fine_tuning.window_frames < 2)
    throw ConfigError("fine-tuning.window-frames must be at least 2");
  require_share("fine-tuning.dropout", fine_tuning.dropout);
  require_share("fine-tuning.average", fine_tuning.average);
}

}  // namespace mcdbn
