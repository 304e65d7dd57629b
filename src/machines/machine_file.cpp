#include "mcdbn/machines/machine_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/shown.hpp"
#include "machines/machine_tensors.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;
constexpr const char* kKey = "mcdbn_machine";

/// Prefix of the names of an MCDBN's AnswerDeviation, which is of the last modality.
std::string deviation_prefix(const MrbmShape& shape) {
  return shape.modalities.back().name + ".deviation.";
}

/// Puts a machine's tensors into the file and returns its description.
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
    about["sampling"] = sampling_json(network.sampling);
    put_answer_deviation(file, deviation_prefix(network.mrbm.shape()), network.deviation);
    return about;
  }
};

Mcdbn mcdbn_from(Device& device, const TensorFile& file, const JsonPlace& about) {
  const MrbmShape shape = mrbm_shape_from(about);
  std::vector<Cdbn> cdbns;
  for (std::size_t m = 0; m < shape.modalities.size(); ++m) {
    const JsonPlace layers = about["cdbns"].at(m);
    cdbns.push_back(get_cdbn(device, file, shape.modalities[m].name + ".", layers));
    if (cdbns.back().code_dimension() != shape.modalities[m].visible)
      layers.fail("the code of the last layer is not what the MRBM sees");
  }
  Mcdbn network{std::move(cdbns), get_mrbm(device, file, "mrbm.", shape),
                about["look_ahead"].count(size_limits::kLookAhead),
                about["mean_field_steps"].count(size_limits::kMeanFieldSteps)};
  network.fills_gaps = about["fills_gaps"].truth();
  network.sampling = sampling_from(about);
  network.deviation = get_answer_deviation(file, deviation_prefix(shape), network.cdbns.back());
  return network;
}

decltype(SavedMachine::machine) machine_from(Device& device, const TensorFile& file,
                                             const JsonPlace& about) {
  const std::string kind = about["kind"].text();
  if (kind == "crbm") return get_crbm(device, file, "", about["layers"].at(0));
  if (kind == "cdbn") return get_cdbn(device, file, "", about["layers"]);
  if (kind == "mrbm") return get_mrbm(device, file, "", mrbm_shape_from(about));
  if (kind == "mcdbn") return mcdbn_from(device, file, about);
  about["kind"].fail("a machine of unknown kind " + shown(kind));
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

/// Number of visible units of each modality, or of a stack.
struct VisibleUnits {
  std::vector<std::size_t> operator()(const Crbm& crbm) const { return {crbm.shape().visible}; }
  std::vector<std::size_t> operator()(const Cdbn& cdbn) const {
    return {cdbn.layers.front().shape().visible};
  }
  std::vector<std::size_t> operator()(const Mrbm& mrbm) const {
    std::vector<std::size_t> units;
    for (const Modality& modality : mrbm.shape().modalities) units.push_back(modality.visible);
    return units;
  }
  std::vector<std::size_t> operator()(const Mcdbn& network) const {
    std::vector<std::size_t> units;
    for (const Cdbn& cdbn : network.cdbns) units.push_back(cdbn.layers.front().shape().visible);
    return units;
  }
};

/// @param visible of each modality, which its scale fits if it has one
std::vector<ColumnScale> scales_from(const TensorFile& file, const JsonPlace& columns,
                                     const std::vector<std::size_t>& visible) {
  std::vector<ColumnScale> scales;
  for (const JsonPlace& place : columns.list()) {
    const std::size_t m = scales.size();
    const std::size_t count = place.count(within(0, size_limits::kUnits.most));
    if (m >= visible.size() || (count != 0 && count != visible[m]))
      place.fail(fmt::format("a scale of {} columns for data that are not there", count));
    scales.push_back({get_matrix(file, scale_prefix(m) + "mean", 1, count, kAnyFinite),
                      get_deviation(file, scale_prefix(m) + "deviation", count, kAnyFinite)});
  }
  return scales;
}

/// Whether any scale has columns: where nothing was scaled an MRBM may have empty ones.
bool has_columns(const JsonPlace& scales) {
  return std::ranges::any_of(scales.list(), [](const JsonPlace& place) {
    return place.count(within(0, size_limits::kUnits.most)) > 0;
  });
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
  const json about = parsed_description(file);
  const JsonPlace place(about, file.path);
  SavedMachine saved{machine_from(device, file, place), {}, place["config"].value()};
  saved.scales = scales_from(file, place["scales"], std::visit(VisibleUnits{}, saved.machine));
  return saved;
}

bool is_machine_file(const std::filesystem::path& path) {
  return read_safetensors(path).metadata.contains(kKey);
}

nlohmann::json describe_machine(const std::filesystem::path& path) {
  const Safetensors content = read_safetensors(path);
  const TensorFile file{content, path.string()};
  json about = parsed_description(file);
  about["parameters"] = parameter_count(content);
  about["standardized"] = has_columns(JsonPlace(about, file.path)["scales"]);
  about.erase("scales");
  return about;
}

}  // namespace mcdbn
