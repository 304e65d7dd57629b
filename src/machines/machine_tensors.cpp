#include "machines/machine_tensors.hpp"

#include <fmt/format.h>

namespace mcdbn {
namespace {

using nlohmann::json;

const char* name_of(VisibleKind kind) {
  return kind == VisibleKind::gaussian ? "gaussian" : "binary";
}

VisibleKind kind_from(const json& name) {
  return name == "gaussian" ? VisibleKind::gaussian : VisibleKind::binary;
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

CrbmShape shape_from(const json& entry) {
  const std::size_t order = entry.at("order");
  return {entry.at("visible"),
          entry.at("hidden"),
          order,
          kind_from(entry.at("kind")),
          entry.value("order_A", order),
          entry.value("order_B", order)};
}

void put(Safetensors& file, const std::string& prefix, const Parameters& parameters) {
  for (const ParameterShape& shape : parameters.entries())
    file.put(prefix + shape.name, parameters.to_host(shape.name));
}

MatrixF get(const TensorFile& file, const std::string& name, std::size_t rows,
            std::size_t columns) {
  return file.content.get(name, file.path, static_cast<Eigen::Index>(rows),
                          static_cast<Eigen::Index>(columns));
}

void get(const TensorFile& file, const std::string& prefix, Parameters parameters) {
  for (const ParameterShape& shape : parameters.entries())
    parameters.upload(shape.name, get(file, prefix + shape.name, shape.rows, shape.columns));
}

std::string layer_prefix(const std::string& prefix, std::size_t layer) {
  return fmt::format("{}{}.", prefix, layer);
}

}  // namespace

json put_crbm(Safetensors& file, const std::string& prefix, const Crbm& crbm) {
  put(file, prefix, crbm.parameters());
  file.put(prefix + "visible_mean", crbm.visible_mean.to_host());
  if (crbm.has_deviation) file.put(prefix + "visible_deviation", crbm.visible_deviation.to_host());
  return shape_json(crbm.shape());
}

Crbm get_crbm(Device& device, const TensorFile& file, const std::string& prefix,
              const json& description) {
  const CrbmShape shape = shape_from(description);
  const Parameters parameters(device, Crbm::parameter_shapes(shape));
  get(file, prefix, parameters);
  const auto row = [&](const char* name) { return get(file, prefix + name, 1, shape.visible); };
  return {parameters, shape, row("visible_mean"),
          file.content.tensors.contains(prefix + "visible_deviation") ? row("visible_deviation")
                                                                      : MatrixF{}};
}

json put_cdbn(Safetensors& file, const std::string& prefix, const Cdbn& cdbn) {
  json shapes = json::array();
  for (std::size_t i = 0; i < cdbn.layers.size(); ++i)
    shapes.push_back(put_crbm(file, layer_prefix(prefix, i), cdbn.layers[i]));
  return shapes;
}

Cdbn get_cdbn(Device& device, const TensorFile& file, const std::string& prefix,
              const json& shapes) {
  Cdbn cdbn;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    cdbn.layers.push_back(get_crbm(device, file, layer_prefix(prefix, i), shapes[i]));
  if (cdbn.layers.empty())
    throw InputError(file.path + ": a CDBN without layers; train the model again");
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

MrbmShape mrbm_shape_from(const json& description) {
  MrbmShape shape{{}, description.at("hidden")};
  for (const json& modality : description.at("modalities"))
    shape.modalities.push_back(
        {modality.at("name"), modality.at("visible"), kind_from(modality.at("kind"))});
  return shape;
}

Mrbm get_mrbm(Device& device, const TensorFile& file, const std::string& prefix,
              const MrbmShape& shape) {
  const Parameters parameters(device, Mrbm::parameter_shapes(shape));
  get(file, prefix, parameters);
  return {parameters, shape};
}

json description_in(const TensorFile& file, const std::string& key, const std::string& what,
                    int format_version) {
  const auto text = file.content.metadata.find(key);
  if (text == file.content.metadata.end())
    throw InputError(fmt::format("{}: not {}", file.path, what));
  json about = json::parse(text->second);
  if (about.at("format_version") != format_version)
    throw InputError(
        fmt::format("{}: model format {}, this program reads {}; train the model again", file.path,
                    about.at("format_version").dump(), format_version));
  return about;
}

}  // namespace mcdbn
