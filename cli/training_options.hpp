#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "mcdbn/motion_model/settings_record.hpp"

namespace mcdbn::cli {

/// Where a training run's settings come from: a preset, then a TOML file, then flags, then what a
/// sweep varies.
class TrainingOptions {
 public:
  /// --preset, --stages, --tracks, --config and a flag for every setting of TrainingConfig.
  void add_to(CLI::App& command);
  /// @param last overrides all others
  /// @param start settings of a model to start from, before files and flags; the greedy stages
  ///        are left out then, unless --stages names them
  /// @throws ConfigError
  TrainingConfig resolve(const std::vector<GivenSetting>& last = {},
                         const std::vector<GivenSetting>& start = {}) const;
  /// @param trained the settings of each training that there will be
  /// @throws ConfigError naming a flag that affects none of them, one that contradicts --stages, or
  ///         a preset that fine-tunes where nothing is fine-tuned
  void check_used(const std::vector<TrainingConfig>& trained) const;

 private:
  void add_setting(CLI::App& command, const Setting& setting, const nlohmann::json& usual);
  void check_stages() const;
  void apply_stages(TrainingConfig& config) const;
  void apply_tracks(TrainingConfig& config) const;

  std::string preset_ = "default", stages_, tracks_, skeleton_;
  std::vector<GivenSetting> file_, flags_;
  JointMap joint_map_;
};

}  // namespace mcdbn::cli
