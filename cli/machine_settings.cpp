#include "machine_settings.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mcdbn::cli {
namespace {

using nlohmann::json;

/// The CRBMs of a machine; none of an MRBM alone.
std::vector<json> layers_of(const json& description) {
  std::vector<json> layers;
  const auto add = [&](const json& stack) {
    layers.insert(layers.end(), stack.begin(), stack.end());
  };
  if (description.contains("layers")) add(description["layers"]);
  if (description.contains("cdbns"))
    for (const json& stack : description["cdbns"]) add(stack);
  return layers;
}

bool has_history(const json& layer) {
  return layer.contains("order") && layer["order"] != 0;
}

class Used {
 public:
  explicit Used(const json& description)
      : layers_(layers_of(description)),
        kind_(description.value("kind", json())),
        config_(description["config"]) {}

  /// @param name with dots
  bool operator()(const std::string& name) const {
    for (const char* group : {"gaussian", "binary"})
      if (const std::string prefix = std::string(group) + "."; name.starts_with(prefix))
        return of_units(group, name.substr(prefix.size()));
    if (name.starts_with("mrbm.")) return kind_ == "mrbm" || kind_ == "mcdbn";
    if (name == "order") return any_layer(has_history) && !config_.contains("orders");
    if (name == "layers") return kind_ != "crbm" && kind_ != "mrbm" && !config_.contains("widths");
    if (name == "hidden") return !config_.contains("widths");
    return true;
  }

 private:
  template <typename Test>
  bool any_layer(const Test& test) const {
    return std::ranges::any_of(layers_, test);
  }
  bool of_units(const std::string& kind, const std::string& name) const {
    return any_layer([&](const json& layer) {
      if (!layer.contains("kind") || layer["kind"] != kind) return false;
      if (name == "rate-A" || name == "rate-B" || name == "history-noise")
        return has_history(layer);
      return name != "deviation-rate" || (kind == "gaussian" && !has_history(layer));
    });
  }

  std::vector<json> layers_;
  json kind_;
  const json& config_;
};

void add_settings(const json& record, const std::string& prefix, const Used& is_used,
                  json& settings) {
  for (const auto& [key, value] : record.items()) {
    if (value.is_object())
      add_settings(value, prefix + key + ".", is_used, settings);
    else if (is_used(prefix + key))
      settings[prefix + key] = value;
  }
}

}  // namespace

json settings_of(const json& description) {
  json settings = json::object();
  add_settings(description["config"], "", Used(description), settings);
  return settings;
}

}  // namespace mcdbn::cli
