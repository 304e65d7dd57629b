#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/base/given_setting.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// Sets them in their order; beside the settings also `skeleton`, "own" or "canonical", and
/// `joint-map.ROLE`, the name of a joint.
/// @throws ConfigError for a setting that does not exist, a value of another kind or out of range
void assign_settings(TrainingConfig& config, const std::vector<GivenSetting>& given);

/// The settings of a TOML file, in which groups are tables.
/// @throws ConfigError `file:line: what` if it is missing or no TOML; its values are not checked
std::vector<GivenSetting> read_settings_file(const std::filesystem::path& file);

/// All settings, the skeleton where it is chosen and the joint map, as a TOML file that
/// read_settings_file reads.
std::string settings_toml(const TrainingConfig& config);

/// All settings by name, nested at the dots: the record in a model file.
nlohmann::json settings_json(const TrainingConfig& config);
/// The settings that a model file records, as they are: other versions had other ranges.
/// @throws ConfigError if they are not this program's
TrainingConfig settings_from_json(const nlohmann::json& record);

}  // namespace mcdbn
