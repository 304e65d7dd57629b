#include "mcdbn/motion_model/model_file.hpp"

#include <fmt/format.h>

#include "base/setting_values.hpp"
#include "machines/machine_tensors.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion_model/modalities_json.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;

constexpr const char* kMrbmPrefix = "mrbm.";

json sampling_json(const SamplingRule& rule) {
  return {{"gibbs_steps", rule.gibbs_steps},
          {"mrbm_gibbs_steps", rule.mrbm_gibbs_steps},
          {"steady", rule.steady},
          {"scale", rule.scale},
          {"always", rule.always}};
}

/// Algorithm 5's rule for models that say none.
SamplingRule sampling_from(const json& about) {
  if (!about.contains("sampling")) return {};
  const json& entry = about.at("sampling");
  return {entry.at("gibbs_steps"), entry.at("mrbm_gibbs_steps"), entry.at("steady"),
          entry.at("scale"), entry.value("always", false)};
}

json parsed_description(const TensorFile& file) {
  return description_in(file, "mcdbn", "a model of mcdbn-cl", kFormatVersion);
}

Model model_from(Device& device, const TensorFile& file) {
  const json about = parsed_description(file);
  std::vector<Cdbn> cdbns;
  MrbmShape shape{{}, about.at("mrbm_hidden")};
  for (const std::string name : kModalityNames) {
    cdbns.push_back(get_cdbn(device, file, name + ".", about.at(name)));
    shape.modalities.push_back({name, cdbns.back().code_dimension()});
  }
  Mrbm mrbm = get_mrbm(device, file, kMrbmPrefix, shape);
  Model model{{std::move(cdbns), std::move(mrbm), about.at("look_ahead"),
               about.at("mean_field_steps"), sampling_from(about), about.value("fills_gaps", true)},
              modalities_from(about.at("modalities")),
              {},
              about.at("config")};
  for (const json& clip : about.at("training_clips"))
    model.training_clips.push_back({clip.at("path"), clip.at("fingerprint")});
  if (about.contains("early_stopping")) {
    const json& stopped = about.at("early_stopping");
    model.early_stopping =
        EarlyStopping{stopped.at("held_out"), stopped.at("steps"), stopped.at("loss")};
  }
  return model;
}

}  // namespace

void save_model(const std::filesystem::path& path, const Model& model) {
  Safetensors file;
  json about;
  about["format_version"] = kFormatVersion;
  for (std::size_t m = 0; m < model.network.modality_count(); ++m) {
    const std::string& name = model.network.modality(m).name;
    about[name] = put_cdbn(file, name + ".", model.network.cdbns[m]);
  }
  put_mrbm(file, kMrbmPrefix, model.network.mrbm);
  about["mrbm_hidden"] = model.network.mrbm.hidden();
  about["look_ahead"] = model.network.look_ahead;
  about["mean_field_steps"] = model.network.mean_field_steps;
  about["fills_gaps"] = model.network.fills_gaps;
  about["sampling"] = sampling_json(model.network.sampling);
  about["modalities"] = modalities_json(model.modalities);
  about["config"] = model.config;
  about["training_clips"] = json::array();
  for (const TrainingClip& clip : model.training_clips)
    about["training_clips"].push_back({{"path", clip.path}, {"fingerprint", clip.fingerprint}});
  if (const auto& stopped = model.early_stopping)
    about["early_stopping"] = {
        {"held_out", stopped->held_out}, {"steps", stopped->steps}, {"loss", stopped->loss}};
  file.metadata["mcdbn"] = about.dump();
  write_safetensors(path, file);
}

Model load_model(Device& device, const std::filesystem::path& path) {
  const Safetensors file = read_safetensors(path);
  return reading_description(path.string(), [&] {
    return model_from(device, {file, path.string()});
  });
}

nlohmann::json describe_model(const std::filesystem::path& path) {
  const Safetensors file = read_safetensors(path);
  return reading_description(path.string(), [&] {
    const json about = parsed_description({file, path.string()});
    const json& config = about.at("config");
    std::size_t numbers = 0;
    for (const auto& [name, tensor] : file.tensors) numbers += tensor.values.size();
    json clips = json::array();
    for (const json& clip : about.at("training_clips"))
      clips.push_back(
          std::filesystem::path(clip.at("path").get<std::string>()).filename().string());
    json description = {{"training_clips", clips}, {"parameters", numbers}};
    for (const char* name : {"fps", "order", "layers", "hidden", "mrbm-hidden", "camera.azimuth",
                             "camera.elevation", "camera.fov", "seed"})
      if (const json::json_pointer place = record_pointer(name); config.contains(place))
        description[name] = config.at(place);
    for (const char* name : {"look_ahead", "mean_field_steps", "early_stopping"})
      if (about.contains(name)) description[name] = about.at(name);
    return description;
  });
}

}  // namespace mcdbn
