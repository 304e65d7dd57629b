#include "training_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include "machine_settings.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/joint_map.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

/// The group of options that the help does not list.
constexpr const char* kHidden = "";

const std::vector<std::pair<std::string, TrainingConfig (*)()>> kPresets = {
    {"default", [] { return TrainingConfig(); }},
    {"paper", TrainingConfig::paper},
    {"paper-stable", TrainingConfig::paper_stable},
    {"generation", TrainingConfig::generation},
    {"general", TrainingConfig::general}};

/// The heading in the help: "Settings of fine-tuning", or "Settings".
std::string group_of(const std::string& setting) {
  const auto dot = setting.find('.');
  return dot == std::string::npos ? "Settings" : "Settings of " + setting.substr(0, dot);
}

/// The flag as it stands on the command line.
std::string as_given(const GivenSetting& flag) {
  if (!flag.value.is_boolean()) return fmt::format("{} {}", flag.who, flag.value.dump());
  return flag.value.get<bool>() ? flag.who : "--no-" + flag.who.substr(2);
}

bool fine_tunes(const TrainingConfig& config) {
  return config.fine_tuning.steps > 0;
}

/// The networks' layers, from below, and the MRBM.
MachineParts parts_of(const TrainingConfig& config) {
  const bool has_history = config.order > 0;
  MachineParts parts{.layers = {{VisibleKind::gaussian, has_history}}, .has_mrbm = true};
  parts.layers.resize(config.layers, {VisibleKind::binary, has_history});
  return parts;
}

/// Why a training with these settings does not depend on one of them; empty if it does.
std::string why_ignored(const TrainingConfig& config, const std::string& setting) {
  const auto is_of = [&](const char* group) { return setting.starts_with(group); };
  if (!fine_tunes(config)) {
    if (is_of("augment."))
      return "is of the views that fine-tuning learns from, and nothing is fine-tuned";
    if (is_of("fine-tuning.") && setting != "fine-tuning.steps")
      return "is of fine-tuning, and nothing is fine-tuned";
  }
  constexpr std::array kOfGreedyStages{"batch", "least-batches", "people-power"};
  const bool is_greedy = is_of("gaussian.") || is_of("binary.") || is_of("mrbm.") ||
                         std::ranges::count(kOfGreedyStages, setting) > 0;
  if (is_greedy && fine_tunes(config) && !config.fine_tuning.from_greedy)
    return "is of the greedy stages, which are left out";
  if (is_of("binary.") && config.layers == 1)
    return "is of the layers above the lowest, and there is one layer";
  if (is_of("regeneration.") && fine_tunes(config))
    return "is of networks that are not fine-tuned: fine-tuning finds out itself how to draw";
  // By these steps the greedy stages' network infers, too.
  if (setting == "mrbm.mean-field-steps" && !fine_tunes(config)) return {};
  const std::string why = why_unused(parts_of(config), setting);
  return why.empty() ? why_unused(config.gaussian, config.binary, config.mrbm, setting) : why;
}

}  // namespace

void TrainingOptions::add_to(CLI::App& command) {
  command
      .add_option(
          "--preset", preset_,
          "default; paper: the paper's own settings, which diverge; paper-stable: the same at "
          "rates that do not; generation: the greedy stages alone, for `generate`: motion of other "
          "presets stops after a while; general: for many people, actions and skeletons and for "
          "detectors' tracks, as the model that comes with the program is trained")
      ->check(CLI::IsMember(kPresets))
      ->capture_default_str();
  command
      .add_option(
          "--stages", stages_,
          "greedy: layer by layer, as in the paper, by default with two layers of order 5 and 300 "
          "units; fine-tuning: the whole network by back-propagation, from random weights; both: "
          "some greedy epochs, then fine-tuning (default, unless a preset says otherwise)")
      ->check(CLI::IsMember({"greedy", "fine-tuning", "both"}))
      ->transform([](const std::string& stages) {
        return stages == "joint" ? "fine-tuning" : stages;  // its name up to version 0.1
      });
  command
      .add_option("--tracks", tracks_,
                  "exact: the clips' own joints; detector: fine-tuning learns from what detectors "
                  "see through cameras all around, in 0.8 of the views unless the preset or "
                  "--config sets another share. --augment-detector overrides both (default: exact, "
                  "unless a preset says otherwise)")
      ->check(CLI::IsMember({"exact", "detector"}));
  command
      .add_option("--skeleton", skeleton_,
                  "own: the clips' own, which all of them must share; canonical: a humanoid onto "
                  "which every clip is brought, so that skeletons may differ (default: own where "
                  "the clips share it, else canonical)")
      ->check(CLI::IsMember({"own", "canonical"}));
  command
      .add_option_function<std::filesystem::path>(
          "--joint-map",
          [this](const std::filesystem::path& file) { joint_map_ = read_joint_map(file); },
          "TOML file of role = \"joint name\", for skeletons whose joint names do not show the "
          "roles; the clips are brought onto the canonical humanoid then (docs/joints.md)")
      ->type_name("FILE");
  command
      .add_option_function<std::filesystem::path>(
          "--config",
          [this](const std::filesystem::path& file) { file_ = read_settings_file(file); },
          "TOML file of settings; flags override it")
      ->type_name("FILE");
  const TrainingConfig usual;
  visit_settings(usual, [&](const Setting& setting, const auto& value) {
    add_setting(command, setting, value);
  });
}

void TrainingOptions::add_setting(CLI::App& command, const Setting& setting,
                                  const nlohmann::json& usual) {
  const auto add = [&](const std::string& flag, const std::string& group) {
    const auto set = [this, flag, name = setting.name](const nlohmann::json& value) {
      flags_.push_back({name, value, flag});
      TrainingConfig scratch;
      assign_settings(scratch, {flags_.back()});  // an invalid value is reported first of all
    };
    if (usual.is_boolean())
      add_switch_flag(command, flag, setting, usual.get<bool>(), set)->group(group);
    else
      add_number_flag(command, flag, setting, set)->default_str(usual.dump())->group(group);
  };
  add(flag_of(setting.name), group_of(setting.name));
  if (const std::string former = former_name(setting.name); !former.empty())
    add(flag_of(former), kHidden);
}

TrainingConfig TrainingOptions::resolve(const std::vector<GivenSetting>& last,
                                        const std::vector<GivenSetting>& start) const {
  const auto applied_to = [&](TrainingConfig config) {
    if (!start.empty()) {
      config.fine_tuning.from_greedy = false;
      config.fine_tuning.rate = FineTuningSettings::kRateFromModel;
    }
    assign_settings(config, start);
    assign_settings(config, file_);
    assign_settings(config, flags_);
    apply_stages(config);
    apply_tracks(config);
    if (!skeleton_.empty()) assign_settings(config, {{"skeleton", skeleton_, "--skeleton"}});
    if (!joint_map_.empty()) config.joint_map = joint_map_;
    assign_settings(config, last);
    return config;
  };
  const auto preset =
      std::ranges::find_if(kPresets, [&](const auto& known) { return known.first == preset_; });
  const TrainingConfig config = applied_to(preset->second());
  const bool greedy = preset_ == "default" && config.fine_tuning.steps == 0;
  return greedy ? applied_to(TrainingConfig::greedy()) : config;
}

void TrainingOptions::check_used(const std::vector<TrainingConfig>& trained) const {
  check_stages();
  const auto refuse_unused = [&](const std::string& setting, const std::string& flag) {
    std::string why;
    for (const TrainingConfig& config : trained)
      if ((why = why_ignored(config, setting)).empty()) return;
    throw ConfigError(fmt::format("{} {}; leave it out", flag, why));
  };
  if (tracks_ == "detector") refuse_unused("augment.detector", "--tracks detector");
  if (preset_ == "general" && std::ranges::none_of(trained, fine_tunes))
    throw ConfigError(
        "--preset general fine-tunes: leave out what turns that off (--stages greedy, "
        "--fine-tuning-steps 0), or choose another preset");
  for (const GivenSetting& given : flags_) refuse_unused(given.name, given.who);
}

void TrainingOptions::check_stages() const {
  TrainingConfig flagged;
  assign_settings(flagged, flags_);
  TrainingConfig staged = flagged;
  apply_stages(staged);
  for (const GivenSetting& given : flags_) {
    const bool contradicts =
        (given.name == "fine-tuning.steps" && fine_tunes(flagged) != fine_tunes(staged)) ||
        (given.name == "fine-tuning.from-greedy" &&
         flagged.fine_tuning.from_greedy != staged.fine_tuning.from_greedy);
    if (contradicts)
      throw ConfigError(fmt::format("--stages {} and {} contradict each other; leave one out",
                                    stages_, as_given(given)));
  }
}

void TrainingOptions::apply_stages(TrainingConfig& config) const {
  if (stages_.empty()) return;
  if (stages_ == "greedy")
    config.fine_tuning.steps = 0;
  else if (config.fine_tuning.steps == 0)
    config.fine_tuning.steps = FineTuningSettings{}.steps;
  config.fine_tuning.from_greedy = stages_ != "fine-tuning";
}

void TrainingOptions::apply_tracks(TrainingConfig& config) const {
  double& share = config.augment.detector;
  if (std::ranges::count(flags_, "augment.detector", &GivenSetting::name) > 0) return;
  if (tracks_ == "exact") share = 0;
  if (tracks_ == "detector" && share == 0) share = TrainingConfig::kShareOfDetectorViews;
}

}  // namespace mcdbn::cli
