#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace mcdbn::test {

/// A training by the program, run once, with every setting at the settings table's value by flags.
class AllSettingsRun {
 public:
  static const AllSettingsRun& instance();
  std::filesystem::path run() const;
  /// The clips of both people: one of them is held out.
  static std::vector<std::filesystem::path> clips();
  static std::string quoted_clips();
  /// Its config.toml.
  const std::map<std::string, double>& recorded() const { return recorded_; }

 private:
  AllSettingsRun();
  std::map<std::string, double> recorded_;
};

/// config.toml of a run, setting by setting.
std::map<std::string, double> recorded_settings(const std::filesystem::path& run);

/// What `train --print-settings` prints for these options.
std::map<std::string, double> settings_of_options(const std::string& options);

}  // namespace mcdbn::test
