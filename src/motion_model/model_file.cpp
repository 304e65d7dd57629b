#include "mcdbn/motion_model/model_file.hpp"

#include <fmt/format.h>

#include <array>

#include "base/setting_values.hpp"
#include "machines/machine_tensors.hpp"
#include "mcdbn/machines/size_limits.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion_model/modalities_json.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;

constexpr const char* kMrbmPrefix = "mrbm.";
constexpr const char* kDeviationPrefix = "pose.deviation.";

/// The settings that there are today, where the record has them.
void check_config(const JsonPlace& config) {
  if (!config.is_object()) config.fail("no settings");
  const TrainingConfig usual;
  visit_settings(usual, [&](const Setting& setting, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const json::json_pointer pointer = record_pointer(setting.name);
    if (!config.value().contains(pointer)) return;
    const JsonPlace given(config.value().at(pointer), config.where() + "." + setting.name);
    if constexpr (std::is_same_v<Value, bool>)
      given.truth();
    else if constexpr (std::is_same_v<Value, std::size_t>)
      given.count(setting.range);
    else
      given.number(setting.range);
  });
}

json parsed_description(const TensorFile& file) {
  return description_in(file, "mcdbn", "a model of mcdbn-cl", kFormatVersion);
}

/// Each modality's frames, as its scale gives them, are what its first layer sees.
void check_frames(const JsonPlace& about, const Modalities& modalities,
                  const std::vector<Cdbn>& cdbns) {
  const std::array<int, 2> dimensions{modalities.track_scale.output_dimension(),
                                      modalities.pose_scale.output_dimension()};
  for (std::size_t m = 0; m < cdbns.size(); ++m)
    if (const std::size_t visible = cdbns[m].layers.front().shape().visible;
        visible != static_cast<std::size_t>(dimensions[m]))
      about[kModalityNames[m]].at(0)["visible"].fail(
          fmt::format("{} units for frames of {} numbers", visible, dimensions[m]));
}

Mcdbn network_from(Device& device, const TensorFile& file, const JsonPlace& about) {
  std::vector<Cdbn> cdbns;
  MrbmShape shape{{}, about["mrbm_hidden"].count(size_limits::kUnits)};
  for (const std::string name : kModalityNames) {
    cdbns.push_back(get_cdbn(device, file, name + ".", about[name]));
    shape.modalities.push_back({name, cdbns.back().code_dimension()});
  }
  Mrbm mrbm = get_mrbm(device, file, kMrbmPrefix, shape);
  return {std::move(cdbns),
          std::move(mrbm),
          about["look_ahead"].count(size_limits::kLookAhead),
          about["mean_field_steps"].count(size_limits::kMeanFieldSteps),
          sampling_from(about),
          !about.has("fills_gaps") || about["fills_gaps"].truth()};
}

/// In the words of train's options. @param config checked
json kind_of_training(const json& config) {
  json kind = json::object();
  if (const auto share = record_pointer("augment.detector"); config.contains(share))
    kind["tracks"] = config.at(share).get<double>() > 0 ? "detector" : "exact";
  const auto steps = record_pointer("fine-tuning.steps"),
             from_greedy = record_pointer("fine-tuning.from-greedy");
  if (config.contains(steps) && config.contains(from_greedy))
    kind["stages"] = config.at(steps) == 0                ? "greedy"
                     : config.at(from_greedy).get<bool>() ? "both"
                                                          : "fine-tuning";
  return kind;
}

TrainingClip training_clip_from(const JsonPlace& clip) {
  const auto given = [&](const char* name) {  // models of before have neither
    return clip.has(name) ? clip[name].text() : std::string();
  };
  return {clip["path"].text(), clip["fingerprint"].text(), {}, given("person"), given("action")};
}

json training_clip_json(const TrainingClip& clip) {
  json about = {{"path", clip.path}, {"fingerprint", clip.fingerprint}};
  if (!clip.person.empty()) about["person"] = clip.person;
  if (!clip.action.empty()) about["action"] = clip.action;
  return about;
}

EarlyStopping early_stopping_from(const JsonPlace& stopped) {
  return {stopped["held_out"].texts(), stopped["steps"].count(any_seed()),
          stopped["loss"].number(any_number())};
}

StartedFrom started_from(const JsonPlace& start) {
  return {start["model"].text(), start["fingerprint"].text()};
}

Model model_from(Device& device, const TensorFile& file) {
  const json description = parsed_description(file);
  const JsonPlace about(description, file.path);
  Model model{network_from(device, file, about),
              modalities_from(about["modalities"]),
              {},
              about["config"].value()};
  model.network.deviation =
      get_answer_deviation(file, kDeviationPrefix, model.network.cdbns[kPose]);
  check_config(about["config"]);
  check_frames(about, model.modalities, model.network.cdbns);
  for (const JsonPlace& clip : about["training_clips"].list())
    model.training_clips.push_back(training_clip_from(clip));
  if (about.has("early_stopping"))
    model.early_stopping = early_stopping_from(about["early_stopping"]);
  if (about.has("started_from")) model.started_from = started_from(about["started_from"]);
  return model;
}

}  // namespace

void save_model(const std::filesystem::path& path, const Model& model, StoredNumbers stored) {
  Safetensors file;
  file.half = stored == StoredNumbers::half;
  json about;
  about["format_version"] = kFormatVersion;
  for (std::size_t m = 0; m < model.network.modality_count(); ++m) {
    const std::string& name = model.network.modality(m).name;
    about[name] = put_cdbn(file, name + ".", model.network.cdbns[m]);
  }
  put_mrbm(file, kMrbmPrefix, model.network.mrbm);
  put_answer_deviation(file, kDeviationPrefix, model.network.deviation);
  about["mrbm_hidden"] = model.network.mrbm.hidden();
  about["look_ahead"] = model.network.look_ahead;
  about["mean_field_steps"] = model.network.mean_field_steps;
  about["fills_gaps"] = model.network.fills_gaps;
  about["sampling"] = sampling_json(model.network.sampling);
  about["modalities"] = modalities_json(model.modalities);
  about["config"] = model.config;
  about["training_clips"] = json::array();
  for (const TrainingClip& clip : model.training_clips)
    about["training_clips"].push_back(training_clip_json(clip));
  if (const auto& stopped = model.early_stopping)
    about["early_stopping"] = {
        {"held_out", stopped->held_out}, {"steps", stopped->steps}, {"loss", stopped->loss}};
  if (const auto& start = model.started_from)
    about["started_from"] = {{"model", start->model}, {"fingerprint", start->fingerprint}};
  file.metadata["mcdbn"] = about.dump();
  write_safetensors(path, file);
}

Model load_model(Device& device, const std::filesystem::path& path) {
  return model_from(device, {read_safetensors(path), path.string()});
}

nlohmann::json describe_model(const std::filesystem::path& path) {
  const Safetensors file = read_safetensors(path);
  const json parsed = parsed_description({file, path.string()});
  const JsonPlace about(parsed, path.string());
  const json& config = about["config"].value();
  check_config(about["config"]);
  json clips = json::array();
  for (const JsonPlace& clip : about["training_clips"].list())
    clips.push_back(std::filesystem::path(clip["path"].text()).filename().string());
  json description = {{"training_clips", clips}, {"parameters", parameter_count(file)}};
  for (const char* name :
       {"fps", "order", "layers", "hidden", "mrbm-hidden", "camera.azimuth", "camera.elevation",
        "camera.fov", "seed", "gaussian.history-noise", "fine-tuning.steps"})
    if (const json::json_pointer place = record_pointer(name); config.contains(place))
      description[name] = config.at(place);
  description.update(kind_of_training(config));
  description["skeleton"] =
      is_humanoid(modalities_from(about["modalities"]).pose_features.skeleton()) ? "canonical"
                                                                                 : "own";
  if (about.has("look_ahead"))
    description["look_ahead"] = about["look_ahead"].count(size_limits::kLookAhead);
  if (about.has("mean_field_steps"))
    description["mean_field_steps"] = about["mean_field_steps"].count(size_limits::kMeanFieldSteps);
  if (about.has("early_stopping")) {
    early_stopping_from(about["early_stopping"]);
    description["early_stopping"] = about["early_stopping"].value();
  }
  if (about.has("started_from"))
    description["started_from"] =
        std::filesystem::path(started_from(about["started_from"]).model).filename().string();
  if (const auto thanks = file.metadata.find("acknowledgement"); thanks != file.metadata.end())
    description["acknowledgement"] = thanks->second;
  return description;
}

}  // namespace mcdbn
