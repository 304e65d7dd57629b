#include "mcdbn/motion_model/settings_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/setting_values.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

void assign(TrainingConfig& config, const SaidSetting& said, bool check_range) {
  bool found = false;
  visit_settings(config, [&](Setting setting, auto& member) {
    if (setting.name != said.name && former_name(setting.name) != said.name) return;
    found = true;
    if (!check_range) setting.range = any_number();
    assign_value(said.who, setting, said.value, member);
  });
  if (!found) throw ConfigError(fmt::format("{} is no setting", said.who));
}

}  // namespace

void assign_settings(TrainingConfig& config, const std::vector<SaidSetting>& said) {
  for (const SaidSetting& setting : said) assign(config, setting, true);
}

nlohmann::json settings_json(const TrainingConfig& config) {
  return settings_record(config);
}

TrainingConfig settings_from_json(const nlohmann::json& record) {
  TrainingConfig config;
  // Models from before there was fine-tuning say nothing of it.
  config.fine_tuning.steps = 0;
  const nlohmann::json flat = record.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string name = pointer.substr(1);
    std::replace(name.begin(), name.end(), '/', '.');
    assign(config, {name, value, "the model's settings: " + name}, false);
  }
  return config;
}

}  // namespace mcdbn
