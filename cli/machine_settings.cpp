#include "machine_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
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

MachineParts parts_of(const json& description) {
  MachineParts parts;
  const auto kind = description.value("kind", json());
  parts.has_mrbm = kind == "mrbm" || kind == "mcdbn";
  for (const json& layer : layers_of(description))
    parts.layers.push_back(
        {layer.value("kind", json()) == "gaussian" ? VisibleKind::gaussian : VisibleKind::binary,
         layer.contains("order") && layer["order"] != 0});
  return parts;
}

class Used {
 public:
  explicit Used(const json& description)
      : parts_(parts_of(description)),
        kind_(description.value("kind", json())),
        config_(description["config"]) {}

  /// @param name with dots
  bool operator()(const std::string& name) const {
    if (name == "order")
      return std::ranges::any_of(parts_.layers, &MachineParts::Layer::has_history) &&
             !config_.contains("orders");
    if (name == "layers") return kind_ != "crbm" && kind_ != "mrbm" && !config_.contains("widths");
    if (name == "hidden") return !config_.contains("widths");
    return why_unused(parts_, name).empty();
  }

 private:
  MachineParts parts_;
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

/// Why a setting of this group has no effect beside its others.
/// @param name without that of the group
std::string why_unused(const CdSettings& settings, const std::string& group,
                       const std::string& name) {
  if (name == "fast-rate" && !settings.persistent)
    return fmt::format("is of persistent chains, and --{}-persistent is off", group);
  if (name == "cosine" && settings.cosine && settings.final_rate == 1)
    return fmt::format("is of rates that fall, and --{}-final-rate is 1", group);
  if (name == "sparsity-target" && settings.sparsity_strength == 0)
    return fmt::format("is of the pull to that target, and --{}-sparsity-strength is 0", group);
  return {};
}

/// Likewise of `mrbm`. The joint likelihood comes before the perceptron's loss (make_mrbm_rule).
std::string why_unused(const MrbmSettings& settings, const std::string& name) {
  constexpr const char* kJoint = "--mrbm-joint-likelihood";
  constexpr const char* kPerceptron = "--mrbm-perceptron-loss";
  const bool has_chains = settings.joint_likelihood || settings.perceptron_loss;
  if (name == "perceptron-loss" && settings.perceptron_loss && settings.joint_likelihood)
    return fmt::format("is another rule than {}, which is on", kJoint);
  if (name == "persistent" && settings.persistent && !settings.joint_likelihood)
    return fmt::format("is of the joint likelihood's chains, and {} is off", kJoint);
  if ((name == "gibbs-steps" || (name == "sample-visible" && settings.sample_visible)) &&
      !has_chains)
    return fmt::format("is of Gibbs chains, and {} and {} are off", kJoint, kPerceptron);
  if (name == "mean-field-steps" && has_chains)
    return fmt::format("is of multi-prediction, and {} is on",
                       settings.joint_likelihood ? kJoint : kPerceptron);
  return {};
}

}  // namespace

std::string why_unused(const MachineParts& machine, const std::string& setting) {
  const std::string group = setting.substr(0, setting.find('.'));
  if (group == "mrbm") return machine.has_mrbm ? "" : "is of MRBMs, and there is none";
  if (group != "gaussian" && group != "binary") return {};
  const auto visible = group == "gaussian" ? VisibleKind::gaussian : VisibleKind::binary;
  const auto any = [&](auto&& test) {
    return std::ranges::any_of(machine.layers, [&](const MachineParts::Layer& layer) {
      return layer.visible == visible && test(layer);
    });
  };
  const auto is_any = [](const MachineParts::Layer&) { return true; };
  const auto has_history = [](const MachineParts::Layer& layer) { return layer.has_history; };
  if (!any(is_any))
    return fmt::format("is of layers with {} visible units, and there is none",
                       visible == VisibleKind::gaussian ? "Gaussian" : "binary");
  const std::string name = setting.substr(group.size() + 1);
  if ((name == "rate-A" || name == "rate-B" || name == "history-noise") && !any(has_history))
    return "is of layers with history, and there is none";
  const bool learns_deviation = visible == VisibleKind::gaussian && any(std::not_fn(has_history));
  if (name == "deviation-rate" && !learns_deviation)
    return "is of Gaussian units without history, and there are none";
  return {};
}

std::string why_unused(const CdSettings& gaussian, const CdSettings& binary,
                       const MrbmSettings& mrbm, const std::string& setting) {
  const auto dot = setting.find('.');
  const std::string group = setting.substr(0, dot);
  if (group == "mrbm") return why_unused(mrbm, setting.substr(dot + 1));
  if (group == "gaussian") return why_unused(gaussian, group, setting.substr(dot + 1));
  if (group == "binary") return why_unused(binary, group, setting.substr(dot + 1));
  return {};
}

json settings_of(const json& description) {
  json settings = json::object();
  add_settings(description["config"], "", Used(description), settings);
  return settings;
}

}  // namespace mcdbn::cli
