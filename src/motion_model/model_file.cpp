#include "mcdbn/motion_model/model_file.hpp"

#include <fmt/format.h>

#include "base/safetensors.hpp"
#include "base/setting_values.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion_model/modalities_json.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;

json shape_json(const CrbmShape& shape) {
  json entry = {{"visible", shape.visible},
                {"hidden", shape.hidden},
                {"order", shape.order},
                {"kind", shape.kind == VisibleKind::gaussian ? "gaussian" : "binary"}};
  if (shape.order_A() != shape.order) entry["order_A"] = shape.order_A();
  if (shape.order_B() != shape.order) entry["order_B"] = shape.order_B();
  return entry;
}

CrbmShape shape_from(const json& entry) {
  const std::size_t order = entry.at("order");
  return {entry.at("visible"),
          entry.at("hidden"),
          order,
          entry.at("kind") == "gaussian" ? VisibleKind::gaussian : VisibleKind::binary,
          entry.value("order_A", order),
          entry.value("order_B", order)};
}

void put(Safetensors& file, const std::string& prefix, const Parameters& parameters) {
  for (const ParameterShape& shape : parameters.entries())
    file.put(prefix + shape.name, parameters.to_host(shape.name));
}

void get(const Safetensors& file, const std::string& path, const std::string& prefix,
         Parameters parameters) {
  for (const ParameterShape& shape : parameters.entries())
    parameters.upload(shape.name,
                      file.get(prefix + shape.name, path, static_cast<Eigen::Index>(shape.rows),
                               static_cast<Eigen::Index>(shape.columns)));
}

json put_cdbn(Safetensors& file, const std::string& name, const Cdbn& cdbn) {
  json shapes = json::array();
  for (std::size_t i = 0; i < cdbn.layers.size(); ++i) {
    const std::string prefix = fmt::format("{}.{}.", name, i);
    put(file, prefix, cdbn.layers[i].parameters());
    file.put(prefix + "visible_mean", cdbn.layers[i].visible_mean.to_host());
    const MatrixF deviation = cdbn.layers[i].visible_deviation.to_host();
    if ((deviation.array() != 1.0F).any()) file.put(prefix + "visible_deviation", deviation);
    shapes.push_back(shape_json(cdbn.layers[i].shape()));
  }
  return shapes;
}

Cdbn get_cdbn(Device& device, const Safetensors& file, const std::string& path,
              const std::string& name, const json& shapes) {
  Cdbn cdbn;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string prefix = fmt::format("{}.{}.", name, i);
    const CrbmShape shape = shape_from(shapes[i]);
    const Parameters parameters(device, Crbm::parameter_shapes(shape));
    get(file, path, prefix, parameters);
    const auto row = [&](const char* what) {
      return file.get(prefix + what, path, 1, static_cast<Eigen::Index>(shape.visible));
    };
    cdbn.layers.emplace_back(
        parameters, shape, row("visible_mean"),
        file.tensors.contains(prefix + "visible_deviation") ? row("visible_deviation") : MatrixF{});
  }
  if (cdbn.layers.empty())
    throw InputError(path + ": a CDBN without layers; train the model again");
  return cdbn;
}

constexpr const char* kMrbmPrefix = "mrbm.";

Mrbm get_mrbm(Device& device, const Safetensors& file, const std::string& path,
              const MrbmShape& shape) {
  const Parameters parameters(device, Mrbm::parameter_shapes(shape));
  get(file, path, kMrbmPrefix, parameters);
  return {parameters, shape};
}

json sampling_json(const SamplingRule& rule) {
  return {{"gibbs_steps", rule.gibbs_steps},
          {"mrbm_gibbs_steps", rule.mrbm_gibbs_steps},
          {"steady", rule.steady},
          {"scale", rule.scale}};
}

/// Algorithm 5's rule for models that say none.
SamplingRule sampling_from(const json& about) {
  if (!about.contains("sampling")) return {};
  const json& entry = about.at("sampling");
  return {entry.at("gibbs_steps"), entry.at("mrbm_gibbs_steps"), entry.at("steady"),
          entry.at("scale")};
}

json parsed_description(const Safetensors& file, const std::string& path) {
  const auto text = file.metadata.find("mcdbn");
  if (text == file.metadata.end()) throw InputError(path + ": not a model of mcdbn-cl");
  json about = json::parse(text->second);
  if (about.at("format_version") != kFormatVersion)
    throw InputError(
        fmt::format("{}: model format {}, this program reads {}; train the model again", path,
                    about.at("format_version").dump(), kFormatVersion));
  return about;
}

/// What `read` makes of a description, whose errors say which file is damaged.
template <typename Read>
auto reading_description(const std::filesystem::path& path, Read&& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: damaged model description: {}", path.string(), error.what()));
  }
}

Model model_from(Device& device, const Safetensors& file, const std::string& path) {
  const json about = parsed_description(file, path);
  std::vector<Cdbn> cdbns;
  MrbmShape shape{{}, about.at("mrbm_hidden")};
  for (const char* name : kModalityNames) {
    cdbns.push_back(get_cdbn(device, file, path, name, about.at(name)));
    shape.modalities.push_back({name, cdbns.back().code_dimension()});
  }
  Mrbm mrbm = get_mrbm(device, file, path, shape);
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
    about[name] = put_cdbn(file, name, model.network.cdbns[m]);
  }
  put(file, kMrbmPrefix, model.network.mrbm.parameters());
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
  return reading_description(path, [&] { return model_from(device, file, path.string()); });
}

nlohmann::json describe_model(const std::filesystem::path& path) {
  const Safetensors file = read_safetensors(path);
  return reading_description(path, [&] {
    const json about = parsed_description(file, path.string());
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
