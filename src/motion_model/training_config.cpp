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

void TrainingConfig::validate() const {
  CorpusSettings::validate();
  LearningSettings::validate();
}

}  // namespace mcdbn
