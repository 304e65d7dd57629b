#pragma once

#include <vector>

#include "mcdbn/base/given_setting.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

// A training that starts from a model: its parameters, features and scaling instead of random and
// new ones. The greedy stages are left out: they would train them anew.

/// Settings that belong to the model and that a training cannot change: rate, sizes, camera.
std::vector<GivenSetting> settings_of_start(const Model& start);

/// Whether those settings are the model's, the skeleton is, and there is fine-tuning and nothing
/// before it.
/// @throws ConfigError that names what differs
void check_start(const Model& start, const TrainingConfig& config);

}  // namespace mcdbn
