#include "training_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "mcdbn/base/errors.hpp"
#include "settings_file.hpp"

namespace mcdbn::cli {
namespace {

/// The group of options that the help does not list.
constexpr const char* kHidden = "";

std::string flag_of(const std::string& setting) {
  std::string flag = "--" + setting;
  std::replace(flag.begin(), flag.end(), '.', '-');
  return flag;
}

/// `a.b` of a nested JSON object, made where it is missing.
nlohmann::json& nested(nlohmann::json& root, const std::string& name) {
  std::string pointer = "/" + name;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return root[nlohmann::json::json_pointer(pointer)];
}

template <typename Member>
bool fits(const nlohmann::json& value) {
  if constexpr (std::is_same_v<Member, bool>) return value.is_boolean();
  if constexpr (std::is_floating_point_v<Member>) return value.is_number();
  if (!value.is_number_integer()) return false;
  return std::is_signed_v<Member> || value.is_number_unsigned() || value.get<std::int64_t>() >= 0;
}

void apply_table(TrainingConfig& config, const toml::table& table, const std::string& prefix,
                 const std::filesystem::path& file) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table())
      apply_table(config, *inner, name + ".", file);
    else
      assign_setting(config, name, scalar_of(node), location_of(file, node.source()));
  }
}

}  // namespace

void TrainingOptions::add_to(CLI::App& command) {
  command
      .add_option("--preset", preset_, "default, or paper: the paper's own figures, which diverge")
      ->check(CLI::IsMember({"default", "paper"}))
      ->capture_default_str();
  command
      .add_option(
          "--stages", stages_,
          "greedy: layer by layer, as the paper does, and with two layers of order 5 and 300 "
          "units unless told otherwise; fine-tuning: the whole network by back-propagation, from "
          "random weights; both: some epochs of the one before the other "
          "(default, but for --preset paper)")
      ->check(CLI::IsMember({"greedy", "fine-tuning", "joint", "both"}));
  command
      .add_option_function<std::filesystem::path>(
          "--config",
          [this](const std::filesystem::path& file) {
            file_ = [table = read_settings_file(file, "--config"), file](TrainingConfig& config) {
              apply_table(config, table, "", file);
            };
          },
          "TOML file of settings; flags override it")
      ->type_name("FILE");
  TrainingConfig defaults;
  visit_settings(defaults, [&](const std::string& name, auto& member, const char* help) {
    using Member = std::decay_t<decltype(member)>;
    const auto set = [this, name](const Member& value) {
      flags_.push_back([name, value](TrainingConfig& config) {
        visit_settings(config, [&](const std::string& setting, auto& target, const char*) {
          if constexpr (std::is_same_v<std::decay_t<decltype(target)>, Member>)
            if (setting == name) target = value;
        });
      });
    };
    const auto add_flag = [&](const std::string& flag, const char* group) {
      if constexpr (std::is_same_v<Member, bool>) {
        const std::string both = flag + ",!--no" + flag.substr(1);
        const auto switch_to = [set](std::int64_t count) { set(count > 0); };
        command.add_flag_function(both, switch_to, help)->group(group);
      } else {
        command.add_option_function<Member>(flag, set, help)
            ->default_str(fmt::format("{}", member))
            ->run_callback_for_default(false)
            ->group(group);
      }
    };
    add_flag(flag_of(name), "Settings");
    const std::string former = former_name(name);
    if (!former.empty()) add_flag(flag_of(former), kHidden);
  });
}

TrainingConfig TrainingOptions::resolve(const Change& sweep_change) const {
  const auto applied_to = [&](TrainingConfig config) {
    if (file_) file_(config);
    for (const Change& flag : flags_) flag(config);
    apply_stages(config);
    if (sweep_change) sweep_change(config);
    return config;
  };
  if (preset_ == "paper") return applied_to(TrainingConfig::paper());
  const TrainingConfig config = applied_to({});
  return config.fine_tuning.steps > 0 ? config : applied_to(TrainingConfig::greedy());
}

void TrainingOptions::apply_stages(TrainingConfig& config) const {
  if (stages_.empty()) return;
  if (stages_ == "greedy")
    config.fine_tuning.steps = 0;
  else if (config.fine_tuning.steps == 0)
    config.fine_tuning.steps = FineTuningSettings{}.steps;
  config.fine_tuning.from_greedy = stages_ != "fine-tuning" && stages_ != "joint";
}

void assign_setting(TrainingConfig& config, const std::string& name, const nlohmann::json& value,
                    const std::string& where) {
  bool found = false;
  visit_settings(config, [&](const std::string& setting, auto& member, const char*) {
    if (setting != name && former_name(setting) != name) return;
    found = true;
    using Member = std::decay_t<decltype(member)>;
    if (!fits<Member>(value))
      throw ConfigError(fmt::format("{}: '{}' has a value of the wrong kind", where, name));
    member = value.get<Member>();
  });
  if (!found)
    throw ConfigError(
        fmt::format("{}: unknown setting '{}'; see mcdbn-cl train --help", where, name));
}

nlohmann::json settings_json(const TrainingConfig& config) {
  nlohmann::json json;
  visit_settings(config, [&](const std::string& name, const auto& member, const char*) {
    nested(json, name) = member;
  });
  return json;
}

TrainingConfig settings_from_json(const nlohmann::json& json) {
  TrainingConfig config;
  // Models from before there was fine-tuning say nothing of it.
  config.fine_tuning.steps = 0;
  const nlohmann::json flat = json.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string name = pointer.substr(1);
    std::replace(name.begin(), name.end(), '/', '.');
    assign_setting(config, name, value, "the model's settings");
  }
  return config;
}

std::string settings_toml(const TrainingConfig& config) {
  toml::table table;
  visit_settings(config, [&](const std::string& name, const auto& member, const char*) {
    using Member = std::decay_t<decltype(member)>;
    toml::table* target = &table;
    std::string key = name;
    if (const auto dot = name.find('.'); dot != std::string::npos) {
      target = table.insert(name.substr(0, dot), toml::table{}).first->second.as_table();
      key = name.substr(dot + 1);
    }
    if constexpr (std::is_unsigned_v<Member> && !std::is_same_v<Member, bool>)
      target->insert(key, static_cast<std::int64_t>(member));
    else
      target->insert(key, member);
  });
  std::ostringstream text;
  text << table << '\n';
  return text.str();
}

}  // namespace mcdbn::cli
