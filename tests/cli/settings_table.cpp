#include "settings_table.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace mcdbn::test {
namespace {

/// A member as a number, and a number as the member.
#define SETTING(name, value, member)                                                       \
  {                                                                                        \
    name, value, [](const TrainingConfig& c) { return static_cast<double>(c.member); },    \
        [](TrainingConfig& c, double v) { c.member = static_cast<decltype(c.member)>(v); } \
  }
#define SWITCH(name, value, member)                                            \
  {                                                                            \
    name, value, [](const TrainingConfig& c) { return c.member ? 1.0 : 0.0; }, \
        [](TrainingConfig& c, double v) { c.member = v != 0; }, true           \
  }

}  // namespace

const std::vector<SettingRow>& setting_rows() {
  static const std::vector<SettingRow> rows = {
      SETTING("seed", 7, seed),
      SETTING("fps", 25, fps),
      SETTING("phases", 2, phases),
      SETTING("directions", 3, directions),
      SWITCH("keep-first-frame", 1, keep_first_frame),
      SETTING("order", 3, order),
      SETTING("hidden", 9, hidden),
      SETTING("layers", 2, layers),
      SETTING("mrbm-hidden", 7, mrbm_hidden),
      SETTING("look-ahead", 2, look_ahead),
      SETTING("batch", 13, batch),
      SETTING("least-batches", 5, least_batches),
      SETTING("people-power", 0.3, people_power),
      SETTING("gaussian.gibbs-steps", 2, gaussian.gibbs_steps),
      SETTING("gaussian.rate", 0.0021, gaussian.rate),
      SETTING("gaussian.rate-A", 0.00013, gaussian.rate_A),
      SETTING("gaussian.rate-B", 0.0017, gaussian.rate_B),
      SETTING("gaussian.momentum", 0.55, gaussian.momentum),
      SETTING("gaussian.momentum-from-epoch", 1, gaussian.momentum_from_epoch),
      SETTING("gaussian.weight-decay", 0.0031, gaussian.weight_decay),
      SETTING("gaussian.initial-deviation", 0.023, gaussian.initial_deviation),
      SETTING("gaussian.history-noise", 0.27, gaussian.history_noise),
      SETTING("gaussian.epochs", 4, gaussian.epochs),
      SWITCH("gaussian.persistent", 1, gaussian.persistent),
      SETTING("gaussian.fast-rate", 0.013, gaussian.fast_rate),
      SWITCH("gaussian.sample-visible", 1, gaussian.sample_visible),
      SETTING("gaussian.sparsity-target", 0.23, gaussian.sparsity_target),
      SETTING("gaussian.sparsity-strength", 0.011, gaussian.sparsity_strength),
      SETTING("gaussian.l1", 0.00037, gaussian.l1),
      SWITCH("gaussian.adam", 1, gaussian.adam),
      SETTING("gaussian.final-rate", 0.35, gaussian.final_rate),
      SWITCH("gaussian.cosine", 1, gaussian.cosine),
      SETTING("gaussian.deviation-rate", 0.019, gaussian.deviation_rate),
      SETTING("binary.gibbs-steps", 3, binary.gibbs_steps),
      SETTING("binary.rate", 0.0063, binary.rate),
      SETTING("binary.rate-A", 0.0041, binary.rate_A),
      SETTING("binary.rate-B", 0.0057, binary.rate_B),
      SETTING("binary.momentum", 0.45, binary.momentum),
      SETTING("binary.momentum-from-epoch", 2, binary.momentum_from_epoch),
      SETTING("binary.weight-decay", 0.0071, binary.weight_decay),
      SETTING("binary.initial-deviation", 0.037, binary.initial_deviation),
      SETTING("binary.history-noise", 0.19, binary.history_noise),
      SETTING("binary.epochs", 5, binary.epochs),
      SWITCH("binary.persistent", 1, binary.persistent),
      SETTING("binary.fast-rate", 0.017, binary.fast_rate),
      SWITCH("binary.sample-visible", 1, binary.sample_visible),
      SETTING("binary.sparsity-target", 0.29, binary.sparsity_target),
      SETTING("binary.sparsity-strength", 0.012, binary.sparsity_strength),
      SETTING("binary.l1", 0.00041, binary.l1),
      SWITCH("binary.adam", 1, binary.adam),
      SETTING("binary.final-rate", 0.65, binary.final_rate),
      SWITCH("binary.cosine", 1, binary.cosine),
      SETTING("binary.deviation-rate", 0.021, binary.deviation_rate),
      SETTING("mrbm.rate", 0.0011, mrbm.rate),
      SETTING("mrbm.weight-decay", 0.0019, mrbm.weight_decay),
      SETTING("mrbm.initial-deviation", 0.043, mrbm.initial_deviation),
      SETTING("mrbm.mean-field-steps", 4, mrbm.mean_field_steps),
      SETTING("mrbm.epochs", 2, mrbm.epochs),
      SWITCH("mrbm.joint-likelihood", 1, mrbm.joint_likelihood),
      SWITCH("mrbm.perceptron-loss", 1, mrbm.perceptron_loss),
      SETTING("mrbm.gibbs-steps", 3, mrbm.gibbs_steps),
      SWITCH("mrbm.persistent", 1, mrbm.persistent),
      SWITCH("mrbm.sample-visible", 1, mrbm.sample_visible),
      SWITCH("mrbm.adam", 0, mrbm.adam),
      SETTING("mrbm.momentum", 0.35, mrbm.momentum),
      SETTING("regeneration.gibbs-steps", 4, regeneration.gibbs_steps),
      SETTING("regeneration.mrbm-gibbs-steps", 2, regeneration.mrbm_gibbs_steps),
      SWITCH("regeneration.sampled", 1, regeneration.sampled),
      SETTING("fine-tuning.steps", 6, fine_tuning.steps),
      SETTING("fine-tuning.view-uses", 2, fine_tuning.view_uses),
      SWITCH("fine-tuning.from-greedy", 0, fine_tuning.from_greedy),
      SETTING("fine-tuning.windows", 5, fine_tuning.windows),
      SETTING("fine-tuning.people-power", 0.3, fine_tuning.people_power),
      SETTING("fine-tuning.window-frames", 8, fine_tuning.window_frames),
      SETTING("fine-tuning.settle-frames", 3, fine_tuning.settle_frames),
      SETTING("fine-tuning.rate", 0.0033, fine_tuning.rate),
      SETTING("fine-tuning.weight-decay", 0.7, fine_tuning.weight_decay),
      SETTING("fine-tuning.dropout", 0.2, fine_tuning.dropout),
      SETTING("fine-tuning.average", 0.8, fine_tuning.average),
      SETTING("fine-tuning.positions", 0.6, pose_loss.positions),
      SETTING("fine-tuning.velocities", 0.4, pose_loss.velocities),
      SETTING("fine-tuning.contacts", 0.15, pose_loss.contacts),
      SETTING("fine-tuning.reverse", 0.25, fine_tuning.reverse),
      SETTING("fine-tuning.mean-field-steps", 3, fine_tuning.mean_field_steps),
      SETTING("fine-tuning.hold-out-among", 2, hold_out_among),
      SWITCH("half-precision", 1, half_precision),
      SETTING("augment.views", 3, augment.views),
      SWITCH("augment.mirror", 0, augment.mirror),
      SETTING("augment.azimuth", 11, augment.azimuth_deg),
      SETTING("augment.elevation", 4, augment.elevation_deg),
      SETTING("augment.distance", 0.07, augment.distance),
      SETTING("augment.bone", 0.08, augment.bone),
      SETTING("augment.turn", 3, augment.turn_deg),
      SETTING("augment.speed", 0.09, augment.speed),
      SETTING("augment.noise", 1.5, augment.noise_px),
      SETTING("augment.missing", 0.65, augment.missing),
      SETTING("augment.detector", 0.35, augment.detector),
      SETTING("augment.limbs-exchanged", 0.31, augment.limbs_exchanged),
      SETTING("augment.limbs-turned", 0.32, augment.limbs_turned),
      SETTING("augment.limbs-turned-by", 21, augment.limbs_turned_deg),
      SETTING("augment.arms-anywhere", 0.33, augment.arms_anywhere),
      SETTING("augment.leaning", 0.34, augment.leaning),
      SETTING("augment.leaning-by", 12, augment.leaning_deg),
      SETTING("augment.turning-round", 0.36, augment.turning_round),
      SETTING("augment.gravity", 1.7, augment.gravity_deg),
      SETTING("camera.azimuth", -20, camera.azimuth_deg),
      SETTING("camera.elevation", 6, camera.elevation_deg),
      SETTING("camera.fov", 50, camera.field_of_view_deg),
  };
  return rows;
}

const SettingRow& setting_row(const std::string& name) {
  const auto& rows = setting_rows();
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const SettingRow& row) { return row.name == name; });
  REQUIRE_MESSAGE(found != rows.end(), "no row for the setting ", name);
  return *found;
}

std::string flag_of(const SettingRow& row) {
  std::string flag = row.name;
  std::replace(flag.begin(), flag.end(), '.', '-');
  if (row.is_switch) return (row.value != 0 ? "--" : "--no-") + flag;
  return fmt::format("--{} {}", flag, row.value);
}

std::optional<std::string> apart(const std::string& setting) {
  static const std::map<std::string, std::string> options = {
      {"fine-tuning.from-greedy", ""},
      {"gaussian.deviation-rate", "--order 0"},
      {"binary.deviation-rate", ""},  // of Gaussian units alone
      {"mrbm.mean-field-steps", "--stages both"},
      {"mrbm.perceptron-loss", "--stages both"},
      {"regeneration.gibbs-steps", "--stages greedy"},
      {"regeneration.mrbm-gibbs-steps", "--stages greedy"},
      {"regeneration.sampled", "--stages greedy"}};
  const auto found = options.find(setting);
  return found == options.end() ? std::nullopt : std::optional(found->second);
}

std::string all_flags() {
  std::string flags;
  for (const SettingRow& row : setting_rows())
    if (!apart(row.name)) flags += " " + flag_of(row);
  return flags;
}

namespace {

bool is_greedy_switch(const SettingRow& row) {
  return std::string(row.name) == "fine-tuning.from-greedy";
}

template <typename IsWanted>
std::string toml_of(IsWanted&& is_wanted) {
  std::map<std::string, std::string> tables;  // the settings without a table come first: ""
  for (const SettingRow& row : setting_rows()) {
    const std::string name = row.name;
    if (!is_wanted(row)) continue;
    const auto dot = name.find('.');
    const std::string table = dot == std::string::npos ? "" : name.substr(0, dot);
    const std::string key = dot == std::string::npos ? name : name.substr(dot + 1);
    tables[table] += row.is_switch ? fmt::format("{} = {}\n", key, row.value != 0)
                                   : fmt::format("{} = {}\n", key, row.value);
  }
  std::string text;
  for (const auto& [table, lines] : tables)
    text += table.empty() ? lines : fmt::format("[{}]\n{}", table, lines);
  return text;
}

}  // namespace

std::string toml_of_those_apart() {
  return toml_of([](const SettingRow& row) { return apart(row.name) && !is_greedy_switch(row); });
}

TrainingConfig all_settings() {
  TrainingConfig config;
  for (const SettingRow& row : setting_rows())
    if (!is_greedy_switch(row)) row.write(config, row.value);
  return config;
}

std::string all_toml() {
  return toml_of([](const SettingRow& row) { return !is_greedy_switch(row); });
}

std::vector<std::pair<std::string, double>> settings_in(const std::string& toml) {
  std::vector<std::pair<std::string, double>> settings;
  std::string prefix;
  std::istringstream lines(toml);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) prefix = line.substr(1, line.find(']') - 1) + ".";
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    const std::string value = line.substr(equals + 3);
    if (value.starts_with('"') || value.starts_with('\'')) continue;
    settings.emplace_back(prefix + line.substr(0, equals), value == "true"    ? 1.0
                                                           : value == "false" ? 0.0
                                                                              : std::stod(value));
  }
  return settings;
}

}  // namespace mcdbn::test
