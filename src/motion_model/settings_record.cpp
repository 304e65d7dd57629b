#include "mcdbn/motion_model/settings_record.hpp"

#include <algorithm>

#include "base/setting_values.hpp"
#include "motion_model/text_settings.hpp"

namespace mcdbn {
namespace {

/// Up to version 0.1 all views were made anew after so many mini-batches; now they are replaced one
/// by one, and the old setting is ignored.
constexpr const char* kGone = "fine-tuning.new-views-every";

/// Today's name of a setting that is given by its name now or its former one.
std::string name_today(const std::string& given) {
  std::string name = given;
  const TrainingConfig usual;
  visit_settings(usual, [&](const Setting& setting, const auto&) {
    if (former_name(setting.name) == given) name = setting.name;
  });
  return name;
}

void assign(TrainingConfig& config, GivenSetting given, RangeCheck check) {
  given.name = name_today(given.name);
  if (!assign_text_setting(config, given)) assign_setting(config, given, check);
}

}  // namespace

void assign_settings(TrainingConfig& config, const std::vector<GivenSetting>& given) {
  for (const GivenSetting& setting : given) assign(config, setting, RangeCheck::on);
}

nlohmann::json settings_json(const TrainingConfig& config) {
  return settings_record(config);
}

TrainingConfig settings_from_json(const nlohmann::json& record) {
  TrainingConfig config;
  // Models from before there was fine-tuning have no settings of it.
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
