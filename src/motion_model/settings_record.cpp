#include "mcdbn/motion_model/settings_record.hpp"

#include <algorithm>

#include "base/setting_values.hpp"

namespace mcdbn {
namespace {

/// Up to version 0.1 all views were made anew after so many mini-batches, where they now give way
/// one by one: what a model was trained with then nobody does again.
constexpr const char* kGone = "fine-tuning.new-views-every";

/// Today's name of a setting that is said by the one that it had before.
std::string name_today(const std::string& said) {
  std::string name = said;
  const TrainingConfig usual;
  visit_settings(usual, [&](const Setting& setting, const auto&) {
    if (former_name(setting.name) == said) name = setting.name;
  });
  return name;
}

void assign(TrainingConfig& config, SaidSetting said, RangeCheck check) {
  said.name = name_today(said.name);
  assign_setting(config, said, check);
}

}  // namespace

void assign_settings(TrainingConfig& config, const std::vector<SaidSetting>& said) {
  for (const SaidSetting& setting : said) assign(config, setting, RangeCheck::on);
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
    if (pointer.empty()) continue;  // of an object without any
    std::string name = pointer.substr(1);
    std::replace(name.begin(), name.end(), '/', '.');
    if (name == kGone) continue;
    assign(config, {name, value, "the model's settings: " + name}, RangeCheck::off);
  }
  return config;
}

}  // namespace mcdbn
