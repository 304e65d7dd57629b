#include "machines/machine_tensors.hpp"

#include <fmt/format.h>

#include "base/parsed_json.hpp"
#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

const char* name_of(VisibleKind kind) {
  return kind == VisibleKind::gaussian ? "gaussian" : "binary";
}

VisibleKind kind_from(const JsonPlace& name) {
  for (const VisibleKind kind : {VisibleKind::gaussian, VisibleKind::binary})
    if (name.text() == name_of(kind)) return kind;
  name.fail(fmt::format("{}; gaussian and binary are known", shown(name.text())));
}

json shape_json(const CrbmShape& shape) {
  json entry = {{"visible", shape.visible},
                {"hidden", shape.hidden},
                {"order", shape.order},
                {"kind", name_of(shape.kind)}};
  if (shape.order_A() != shape.order) entry["order_A"] = shape.order_A();
  if (shape.order_B() != shape.order) entry["order_B"] = shape.order_B();
  return entry;
}

CrbmShape shape_from(const JsonPlace& entry) {
  const std::size_t order = entry["order"].count(size_limits::kHistory);
  const auto part = [&](const char* name) {
    return entry.has(name) ? entry[name].count(within(0, static_cast<double>(order))) : order;
  };
  return {entry["visible"].count(size_limits::kUnits),
          entry["hidden"].count(size_limits::kUnits),
          order,
          kind_from(entry["kind"]),
          part("order_A"),
          part("order_B")};
}

void put(Safetensors& file, const std::string& prefix, const Parameters& parameters) {
  for (const ParameterShape& shape : parameters.entries())
    file.put(prefix + shape.name, parameters.to_host(shape.name));
}

/// Parameters of a device with what the file has of them. Every one is looked at before memory is
/// taken: a false size in the description would take any amount.
Parameters get(Device& device, const TensorFile& file, const std::string& prefix,
               const std::vector<ParameterShape>& shapes) {
  std::vector<MatrixF> values;
  values.reserve(shapes.size());
  for (const ParameterShape& shape : shapes)
    values.push_back(get_matrix(file, prefix + shape.name, shape.rows, shape.columns));
  Parameters parameters(device, shapes);
  for (std::size_t i = 0; i < shapes.size(); ++i) parameters.upload(shapes[i].name, values[i]);
  return parameters;
}

std::string layer_prefix(const std::string& prefix, std::size_t layer) {
  return fmt::format("{}{}.", prefix, layer);
}

}  // namespace

MatrixF get_matrix(const TensorFile& file, const std::string& name, std::size_t rows,
                   std::size_t columns, float largest) {
  MatrixF values = file.content.get(name, file.path, static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(columns));
  if (!(values.array().abs() <= largest).all())
    throw InputError(
        fmt::format("{}: tensor {} holds a number that is not finite{}", file.path, name,
                    largest < kAnyFinite ? fmt::format(" or beyond {}", largest) : ""));
  return values;
}

RowVectorF get_deviation(const TensorFile& file, const std::string& name, std::size_t columns,
                         float largest) {
  const MatrixF values = get_matrix(file, name, 1, columns, largest);
  if (!(values.array() > 0).all())
    throw InputError(
        fmt::format("{}: tensor {} holds a deviation that is not above 0", file.path, name));
  return values;
}

json put_crbm(Safetensors& file, const std::string& prefix, const Crbm& crbm) {
  put(file, prefix, crbm.parameters());
  file.put(prefix + "visible_mean", crbm.visible_mean.to_host());
  if (crbm.has_deviation) file.put(prefix + "visible_deviation", crbm.visible_deviation.to_host());
  return shape_json(crbm.shape());
}

Crbm get_crbm(Device& device, const TensorFile& file, const std::string& prefix,
              const JsonPlace& description) {
  const CrbmShape shape = shape_from(description);
  const Parameters parameters = get(device, file, prefix, Crbm::parameter_shapes(shape));
  const float largest = shape.kind == VisibleKind::gaussian ? kAnyFinite : kLargestWeight;
  MatrixF deviation;
  if (const std::string name = prefix + "visible_deviation"; file.content.tensors.contains(name))
    deviation = get_deviation(file, name, shape.visible, largest);
  return {parameters, shape, get_matrix(file, prefix + "visible_mean", 1, shape.visible, largest),
          deviation};
}

json put_cdbn(Safetensors& file, const std::string& prefix, const Cdbn& cdbn) {
  json shapes = json::array();
  for (std::size_t i = 0; i < cdbn.layers.size(); ++i)
    shapes.push_back(put_crbm(file, layer_prefix(prefix, i), cdbn.layers[i]));
  return shapes;
}

Cdbn get_cdbn(Device& device, const TensorFile& file, const std::string& prefix,
              const JsonPlace& shapes) {
  Cdbn cdbn;
  const std::vector<JsonPlace> places = shapes.list();
  if (places.empty()) shapes.fail("a CDBN without layers; train the model again");
  if (!size_limits::kLayers.contains(static_cast<double>(places.size())))
    shapes.fail(
        fmt::format("{} layers; there must be {}", places.size(), size_limits::kLayers.text()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t visible = shape_from(places[i]).visible;
    if (i > 0 && visible != cdbn.layers.back().shape().hidden)
      places[i]["visible"].fail(fmt::format("{} units, but the layer below has {}", visible,
                                            cdbn.layers.back().shape().hidden));
    cdbn.layers.push_back(get_crbm(device, file, layer_prefix(prefix, i), places[i]));
  }
  return cdbn;
}

json put_mrbm(Safetensors& file, const std::string& prefix, const Mrbm& mrbm) {
  put(file, prefix, mrbm.parameters());
  json modalities = json::array();
  for (const Modality& modality : mrbm.shape().modalities)
    modalities.push_back(
        {{"name", modality.name}, {"visible", modality.visible}, {"kind", name_of(modality.kind)}});
  return {{"modalities", modalities}, {"hidden", mrbm.hidden()}};
}

MrbmShape mrbm_shape_from(const JsonPlace& description) {
  MrbmShape shape{{}, description["hidden"].count(size_limits::kUnits)};
  const JsonPlace modalities = description["modalities"];
  for (const JsonPlace& modality : modalities.list())
    shape.modalities.push_back({modality["name"].text(),
                                modality["visible"].count(size_limits::kUnits),
                                kind_from(modality["kind"])});
  try {
    shape.check();
  } catch (const ShapeError& error) {
    modalities.fail(error.what());
  }
  return shape;
}

Mrbm get_mrbm(Device& device, const TensorFile& file, const std::string& prefix,
              const MrbmShape& shape) {
  return {get(device, file, prefix, Mrbm::parameter_shapes(shape)), shape};
}

json sampling_json(const SamplingRule& rule) {
  return {{"gibbs_steps", rule.gibbs_steps},
          {"mrbm_gibbs_steps", rule.mrbm_gibbs_steps},
          {"steady", rule.steady},
          {"scale", rule.scale},
          {"always", rule.sampled}};
}

SamplingRule sampling_from(const JsonPlace& description) {
  if (!description.has("sampling")) return {};
  const JsonPlace entry = description["sampling"];
  return {entry["gibbs_steps"].count(size_limits::kGibbsSteps),
          entry["mrbm_gibbs_steps"].count(size_limits::kGibbsSteps), entry["steady"].truth(),
          entry["scale"].number(within(0, 1000)), entry.has("always") && entry["always"].truth()};
}

void put_answer_deviation(Safetensors& file, const std::string& prefix,
                          const std::optional<AnswerDeviation>& deviation) {
  if (!deviation) return;
  file.put(prefix + "C", deviation->C);
  file.put(prefix + "c", deviation->c);
}

std::optional<AnswerDeviation> get_answer_deviation(const TensorFile& file,
                                                    const std::string& prefix,
                                                    const Cdbn& answered) {
  const std::string slope = prefix + "C", bias = prefix + "c";
  if (!file.content.tensors.contains(slope) && !file.content.tensors.contains(bias)) return {};
  const std::size_t visible = answered.layers.front().shape().visible;
  return AnswerDeviation{get_matrix(file, slope, answered.code_dimension(), visible),
                         get_matrix(file, bias, 1, visible)};
}

std::size_t parameter_count(const Safetensors& content) {
  const auto is_learnt = [](const std::string& name) {
    const bool is_scale =
        name.starts_with("scale.") && (name.ends_with(".mean") || name.ends_with(".deviation"));
    return !is_scale && name != "visible_mean" && !name.ends_with(".visible_mean");
  };
  std::size_t count = 0;
  for (const auto& [name, tensor] : content.tensors)
    if (is_learnt(name)) count += tensor.values.size();
  return count;
}

json description_in(const TensorFile& file, const std::string& key, const std::string& what,
                    int format_version) {
  const auto text = file.content.metadata.find(key);
  if (text == file.content.metadata.end())
    throw InputError(fmt::format("{}: not {}", file.path, what));
  json about = parsed_json(text->second);
  if (about.is_discarded())
    throw InputError(fmt::format("{}: damaged: its description is no JSON", file.path));
  const json version = JsonPlace(about, file.path)["format_version"].value();
  if (version != format_version)
    throw InputError(
        fmt::format("{}: model format {}, this program reads {}; train the model again", file.path,
                    version.dump().substr(0, 40), format_version));
  return about;
}

}  // namespace mcdbn
