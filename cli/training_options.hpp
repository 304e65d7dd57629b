#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn::cli {

/// Where a training run's settings come from: a preset, then a TOML file, then flags, then what a
/// sweep varies.
class TrainingOptions {
 public:
  using Change = std::function<void(TrainingConfig&)>;

  /// --preset, --config and a flag for every setting of TrainingConfig.
  void add_to(CLI::App& command);
  /// @param sweep_change the last word
  /// @return settings whose values may yet be out of range (TrainingConfig::validate)
  /// @throws ConfigError
  TrainingConfig resolve(const Change& sweep_change = {}) const;

 private:
  void apply_stages(TrainingConfig& config) const;

  std::string preset_ = "default", stages_;
  Change file_;  ///< --config, read once
  std::vector<Change> flags_;
};

/// Sets the setting of that name, with dots between the parts of it.
/// @param where what to name in an error: file:line
/// @throws ConfigError if there is no such setting or the value is of the wrong kind
void assign_setting(TrainingConfig& config, const std::string& name, const nlohmann::json& value,
                    const std::string& where);

/// Every setting by its name, nested at the dots.
nlohmann::json settings_json(const TrainingConfig& config);
/// The settings that settings_json recorded. @throws ConfigError
TrainingConfig settings_from_json(const nlohmann::json& json);
/// The same as a TOML file that --config reads.
std::string settings_toml(const TrainingConfig& config);

}  // namespace mcdbn::cli
