#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mcdbn/base/given_setting.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

// What shapes a training and is no number: `skeleton`, and `joint-map.ROLE` for each role given.

/// Those that are set, by name.
std::vector<std::pair<std::string, std::string>> text_settings(const TrainingConfig& config);

/// Sets it if it is one of these. @return whether it is
/// @throws ConfigError for a role that does not exist, and a value that cannot be it
bool assign_text_setting(TrainingConfig& config, const GivenSetting& given);

}  // namespace mcdbn
