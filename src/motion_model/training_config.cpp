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
  return config;
}

std::string former_name(const std::string& setting) {
  const std::string prefix = "fine-tuning.";
  if (!setting.starts_with(prefix)) return {};
  const std::string part = setting.substr(prefix.size());
  return "joint." + (part == "positions" ? "places" : part);
}

}  // namespace mcdbn
