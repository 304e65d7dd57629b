#include "mcdbn/motion_model/training_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/setting_values.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "mcdbn/motion_model/settings_record.hpp"

namespace mcdbn {
namespace {

constexpr std::array<std::string_view, 6> kOfModel{"fps",    "order",       "layers",
                                                   "hidden", "mrbm-hidden", "look-ahead"};

bool is_of_model(const std::string& name) {
  return std::ranges::count(kOfModel, name) > 0 || name.starts_with("camera.");
}

/// Models of the library may have layers of any sizes, which no setting gives.
void check_sizes(const Mcdbn& network, const TrainingConfig& config) {
  for (const Cdbn& cdbn : network.cdbns) {
    bool fits = cdbn.layers.size() == config.layers;
    for (const Crbm& layer : cdbn.layers)
      fits = fits && layer.shape().hidden == config.hidden && layer.shape().order == config.order;
    if (!fits)
      throw ConfigError(
          "the model to start from has layers of other sizes than its settings specify");
  }
}

}  // namespace

std::vector<GivenSetting> settings_of_start(const Model& start) {
  std::vector<GivenSetting> given;
  const TrainingConfig own = settings_from_json(start.config);
  visit_settings(own, [&](const Setting& setting, const auto& value) {
    if (is_of_model(setting.name))
      given.push_back({setting.name, value, "the model to start from: " + setting.name});
  });
  return given;
}

void check_start(const Model& start, const TrainingConfig& config) {
  const nlohmann::json now = settings_json(config);
  for (const GivenSetting& own : settings_of_start(start))
    if (const auto& value = now.at(record_pointer(own.name)); value != own.value)
      throw ConfigError(fmt::format("`{}` is {}, but {} in the model to start from; leave it out",
                                    own.name, value.dump(), own.value.dump()));
  check_sizes(start.network, config);
  if (config.fine_tuning.steps == 0 || config.fine_tuning.from_greedy)
    throw ConfigError(
        "a training that starts from a model is fine-tuning alone: the greedy stages would train "
        "its parameters anew");
  const bool humanoid = is_humanoid(start.modalities.pose_features.skeleton());
  if (humanoid && config.skeleton == SkeletonUse::own)
    throw ConfigError(
        "the model to start from is of the canonical humanoid, not of the clips' own "
        "skeleton");
  if (!humanoid && (config.skeleton == SkeletonUse::humanoid || config.augment.new_poses()))
    throw ConfigError(
        "the model to start from is of its clips' own skeleton, not of the canonical "
        "humanoid");
}

}  // namespace mcdbn
