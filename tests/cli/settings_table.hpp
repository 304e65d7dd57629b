#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn::test {

/// A setting of training by its name, another value than its default, and where it belongs, written
/// down by hand: what visit_settings and the flags give is compared with this.
struct SettingRow {
  const char* name;
  double value;  ///< 1 and 0 for true and false
  double (*read)(const TrainingConfig&);
  void (*write)(TrainingConfig&, double);
  bool is_switch = false;
};

const std::vector<SettingRow>& setting_rows();
const SettingRow& setting_row(const std::string& name);

/// `--gaussian-rate 0.003`, `--no-augment-mirror`.
std::string flag_of(const SettingRow& row);
/// Options beside which the setting has an effect, where it has none beside the values of all
/// others and its flag is refused there.
std::optional<std::string> apart(const std::string& setting);

/// Flags of every setting with the table's values but those that are refused beside the others.
std::string all_flags();
/// Those as the text of a TOML file, in which they are taken, but fine-tuning.from-greedy, which
/// stays on: else nothing of the greedy stages would matter.
std::string toml_of_those_apart();
/// All but that one as a configuration, by assigning members.
TrainingConfig all_settings();
/// The same as the text of a TOML file.
std::string all_toml();

/// The settings of a config.toml that the program wrote, by name, without texts. true and false are
/// 1 and 0.
std::vector<std::pair<std::string, double>> settings_in(const std::string& toml);

}  // namespace mcdbn::test
