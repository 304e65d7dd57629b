#include "comparison/baseline.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "comparison/bimodal_autoencoder.hpp"
#include "comparison/constant_pose.hpp"
#include "comparison/hold_last_frame.hpp"
#include "comparison/mlp_window.hpp"
#include "comparison/multimodal_dbm.hpp"
#include "comparison/nearest_neighbour.hpp"
#include "comparison/ridge_window.hpp"
#include "comparison/twin_gaussian_processes.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

struct Kind {
  std::string name;
  bool usual;
  std::function<std::unique_ptr<Baseline>(Device& device, bool from_views)> make;
};

/// For those that want nothing.
template <typename Made>
std::unique_ptr<Baseline> made(Device&, bool) {
  return std::make_unique<Made>();
}
template <typename Made>
std::unique_ptr<Baseline> made_on_device(Device& device, bool) {
  return std::make_unique<Made>(device);
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"mean_pose", true, made<ConstantPose>},
      {"hold_last_frame", true, made<HoldLastFrame>},
      {"nearest_neighbour", true, made<NearestNeighbour>},
      {"ridge_window", true, made<RidgeWindow>},
      {"mlp_window", true,
       [](Device& device, bool from_views) -> std::unique_ptr<Baseline> {
         return std::make_unique<MlpWindow>(
             device, from_views ? MlpWindow::Settings::for_views() : MlpWindow::Settings());
       }},
      {"bimodal_autoencoder", false, made_on_device<BimodalAutoencoder>},
      {"multimodal_dbm", false, made_on_device<MultimodalDbm>},
      {"twin_gaussian_process", false, made<TwinGaussianProcesses>}};
  return all;
}

std::vector<std::string> names_of(bool usual_only) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds())
    if (kind.usual || !usual_only) names.push_back(kind.name);
  return names;
}

}  // namespace

const std::vector<std::string>& all_baselines() {
  static const std::vector<std::string> names = names_of(false);
  return names;
}

std::vector<std::string> usual_baselines() {
  return names_of(true);
}

std::vector<std::string> baselines_of(const std::vector<std::string>& words) {
  std::vector<std::string> wanted;
  for (const std::string& word : words) {
    if (word == "none") continue;
    const auto& all = all_baselines();
    const std::vector<std::string> meant = word == "all"     ? all
                                           : word == "usual" ? usual_baselines()
                                                             : std::vector<std::string>{word};
    for (const std::string& name : meant)
      if (std::find(all.begin(), all.end(), name) == all.end())
        throw ConfigError(fmt::format("there is no baseline '{}': it is usual, all, none, or of {}",
                                      name, fmt::join(all, ", ")));
    wanted.insert(wanted.end(), meant.begin(), meant.end());
  }
  std::vector<std::string> ordered;
  for (const std::string& name : all_baselines())
    if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) ordered.push_back(name);
  return ordered;
}

std::unique_ptr<Baseline> make_baseline(const std::string& name, Device& device, bool from_views) {
  for (const Kind& kind : kinds())
    if (kind.name == name) return kind.make(device, from_views);
  throw ConfigError(fmt::format("there is no baseline '{}'", name));
}

}  // namespace mcdbn
