#include "mcdbn/machines/machine_file.hpp"

#include "machines/machine_tensors.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;
constexpr const char* kKey = "mcdbn_machine";

/// What a machine says of itself beside its tensors.
struct Put {
  Safetensors& file;
  json operator()(const Crbm& crbm) const {
    return {{"kind", "crbm"}, {"layers", json::array({put_crbm(file, "", crbm)})}};
  }
  json operator()(const Cdbn& cdbn) const {
    return {{"kind", "cdbn"}, {"layers", put_cdbn(file, "", cdbn)}};
  }
  json operator()(const Mrbm& mrbm) const {
    json about = put_mrbm(file, "", mrbm);
    about["kind"] = "mrbm";
    return about;
  }
  json operator()(const Mcdbn& network) const {
    json about = put_mrbm(file, "mrbm.", network.mrbm);
    about["kind"] = "mcdbn";
    about["cdbns"] = json::array();
    for (std::size_t m = 0; m < network.modality_count(); ++m)
      about["cdbns"].push_back(put_cdbn(file, network.modality(m).name + ".", network.cdbns[m]));
    about["look_ahead"] = network.look_ahead;
    about["mean_field_steps"] = network.mean_field_steps;
    about["fills_gaps"] = network.fills_gaps;
    return about;
  }
};

Mcdbn mcdbn_from(Device& device, const TensorFile& file, const json& about) {
  const MrbmShape shape = mrbm_shape_from(about);
  std::vector<Cdbn> cdbns;
  for (std::size_t m = 0; m < shape.modalities.size(); ++m)
    cdbns.push_back(
        get_cdbn(device, file, shape.modalities[m].name + ".", about.at("cdbns").at(m)));
  Mcdbn network{std::move(cdbns), get_mrbm(device, file, "mrbm.", shape), about.at("look_ahead"),
                about.at("mean_field_steps")};
  network.fills_gaps = about.at("fills_gaps");
  return network;
}

decltype(SavedMachine::machine) machine_from(Device& device, const TensorFile& file,
                                             const json& about) {
  const json& kind = about.at("kind");
  if (kind == "crbm") return get_crbm(device, file, "", about.at("layers").at(0));
  if (kind == "cdbn") return get_cdbn(device, file, "", about.at("layers"));
  if (kind == "mrbm") return get_mrbm(device, file, "", mrbm_shape_from(about));
  if (kind == "mcdbn") return mcdbn_from(device, file, about);
  throw InputError(file.path + ": a machine of unknown kind " + kind.dump());
}

std::string scale_prefix(std::size_t modality) {
  return "scale." + std::to_string(modality) + ".";
}

/// How many columns each scale has.
json put_scales(Safetensors& file, const std::vector<ColumnScale>& scales) {
  json columns = json::array();
  for (std::size_t m = 0; m < scales.size(); ++m) {
    columns.push_back(scales[m].mean.cols());
    file.put(scale_prefix(m) + "mean", scales[m].mean);
    file.put(scale_prefix(m) + "deviation", scales[m].deviation);
  }
  return columns;
}

std::vector<ColumnScale> scales_from(const TensorFile& file, const json& columns) {
  std::vector<ColumnScale> scales;
  for (std::size_t m = 0; m < columns.size(); ++m) {
    const auto row = [&](const char* name) -> RowVectorF {
      return file.content.get(scale_prefix(m) + name, file.path, 1, columns[m]);
    };
    scales.push_back({row("mean"), row("deviation")});
  }
  return scales;
}

json parsed_description(const TensorFile& file) {
  return description_in(file, kKey, "a machine that mcdbn-cl fitted", kFormatVersion);
}

}  // namespace

void save_machine(const std::filesystem::path& path, const SavedMachine& saved) {
  Safetensors file;
  json about = std::visit(Put{file}, saved.machine);
  about["format_version"] = kFormatVersion;
  about["scales"] = put_scales(file, saved.scales);
  about["config"] = saved.config;
  file.metadata[kKey] = about.dump();
  write_safetensors(path, file);
}

SavedMachine load_machine(Device& device, const std::filesystem::path& path) {
  const Safetensors content = read_safetensors(path);
  const TensorFile file{content, path.string()};
  return reading_description(file.path, [&]() -> SavedMachine {
    const json about = parsed_description(file);
    return {machine_from(device, file, about), scales_from(file, about.at("scales")),
            about.at("config")};
  });
}

bool is_machine_file(const std::filesystem::path& path) {
  return read_safetensors(path).metadata.contains(kKey);
}

nlohmann::json describe_machine(const std::filesystem::path& path) {
  const Safetensors content = read_safetensors(path);
  const TensorFile file{content, path.string()};
  return reading_description(file.path, [&] {
    json about = parsed_description(file);
    std::size_t numbers = 0;
    for (const auto& [name, tensor] : content.tensors) numbers += tensor.values.size();
    about["parameters"] = numbers;
    about["standardized"] = !about.at("scales").empty();
    about.erase("scales");
    return about;
  });
}

}  // namespace mcdbn
