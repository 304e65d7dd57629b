#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

TrainingConfig TrainingConfig::greedy() {
  TrainingConfig config;
  static_cast<LearningSettings&>(config) = LearningSettings::greedy();
  return config;
}

TrainingConfig TrainingConfig::paper() {
  TrainingConfig config;
  static_cast<LearningSettings&>(config) = LearningSettings::paper();
  return config;
}

TrainingConfig TrainingConfig::paper_stable() {
  TrainingConfig config;
  static_cast<LearningSettings&>(config) = LearningSettings::paper_stable();
  return config;
}

TrainingConfig TrainingConfig::generation() {
  TrainingConfig config;
  static_cast<LearningSettings&>(config) = LearningSettings::generation();
  config.phases = 4;
  config.directions = 4;
  // The number of mini-batches is that of one direction.
  for (std::size_t* epochs : {&config.gaussian.epochs, &config.binary.epochs, &config.mrbm.epochs})
    *epochs /= config.directions;
  return config;
}

TrainingConfig TrainingConfig::general() {
  TrainingConfig config;
  config.skeleton = SkeletonUse::humanoid;
  config.augment.detector = kShareOfDetectorViews;
  config.augment.limbs_exchanged = 0.5;
  config.augment.limbs_turned = 0.4;
  config.augment.arms_anywhere = 0.35;
  config.augment.leaning = 0.25;
  config.augment.turning_round = 0.25;
  config.augment.gravity_deg = 1.5;
  config.fine_tuning.steps = 30000;
  config.fine_tuning.view_uses = 16;
  config.fine_tuning.weight_decay = 0.1;
  config.fine_tuning.windows = 40;
  config.fine_tuning.settle_frames = 10;
  config.hold_out_among = 0;
  return config;
}

std::string former_name(const std::string& setting) {
  const std::string prefix = "fine-tuning.";
  if (!setting.starts_with(prefix)) return {};
  const std::string part = setting.substr(prefix.size());
  return "joint." + (part == "positions" ? "places" : part);
}

}  // namespace mcdbn
