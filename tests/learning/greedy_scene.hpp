#pragma once

// What the tests of the greedy stages share: tiny data, settings that all differ from the defaults
// and from each other, and the way from the reference's plan to the trainer.

#include <map>
#include <string>

#include "base/capture_bound.hpp"
#include "device/every_device.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "reference/greedy_reference.hpp"

namespace mcdbn::test {

/// How far a parameter or a loss may be from the double reference's. Some sixty updates of
/// parameters below 2, each of sums of at most some eighty products: what rounding adds is a few
/// hundred times 2^-24 in the worst case and 1e-6 in fact. A wrong rate, window or draw moves some
/// parameter by more than a thousand times as much ("every setting counts" holds the reference to
/// it).
inline constexpr double kGreedyTolerance = 1e-5;
/// A draw as near as that to its probability could fall otherwise on the device; scenes have seeds
/// without one.
inline constexpr double kClosestDraw = 5e-5;

struct GreedyScene {
  reference::GreedyPlan plan;
  std::vector<MatrixF> tracks, poses;
};

/// Clips of different lengths, the first and a middle one too short to give a window.
inline std::vector<MatrixF> tiny_clips(std::size_t dimension, unsigned seed) {
  std::vector<MatrixF> clips;
  for (const std::size_t frames : {2U, 13U, 1U, 9U, 17U})
    clips.push_back(random_matrix(frames, dimension, seed++, 1.7F));
  return clips;
}

inline reference::GreedyPlan tiny_plan() {
  reference::GreedyPlan plan;
  plan.seed = 7;
  plan.order = 2;
  plan.hidden = 4;
  plan.layers = 2;
  plan.mrbm_hidden = 6;
  plan.look_ahead = 3;
  plan.batch = 4;
  plan.least_batches = 6;  // more than the windows give in the upper layers
  plan.gaussian = {.gibbs_steps = 3,
                   .rate = 0.03,
                   .rate_A = 0.01,
                   .rate_B = 0.02,
                   .momentum = 0.8,
                   .momentum_from_epoch = 2,
                   .weight_decay = 0.05,
                   .initial_deviation = 0.3,
                   .epochs = 4};
  plan.binary = {.gibbs_steps = 2,
                 .rate = 0.2,
                 .rate_A = 0.07,
                 .rate_B = 0.1,
                 .momentum = 0.6,
                 .momentum_from_epoch = 1,
                 .weight_decay = 0.02,
                 .initial_deviation = 0.7,
                 .epochs = 3};
  plan.mrbm = {.rate = 0.02,
               .weight_decay = 0.4,
               .initial_deviation = 0.4,
               .mean_field_steps = 3,
               .epochs = 5};
  return plan;
}

/// All sizes differ.
inline GreedyScene scene_of_different_sizes() {
  return {tiny_plan(), tiny_clips(3, 100), tiny_clips(5, 200)};
}

/// All sizes are equal, so that nothing but the numbers distinguishes matrices; three layers and a
/// seed of more than 32 bits.
inline GreedyScene scene_of_equal_sizes() {
  GreedyScene scene{tiny_plan(), tiny_clips(5, 300), tiny_clips(5, 400)};
  scene.plan.seed = 0x50000000BU;
  scene.plan.order = 1;
  scene.plan.hidden = scene.plan.mrbm_hidden = 5;
  scene.plan.layers = 3;
  scene.plan.look_ahead = 2;
  scene.plan.batch = 3;
  scene.plan.least_batches = 1;
  return scene;
}

/// No history, no look-ahead, one layer, and more windows asked for in a mini-batch than there are.
inline GreedyScene scene_without_history() {
  GreedyScene scene{tiny_plan(), tiny_clips(3, 500), tiny_clips(5, 600)};
  scene.plan.seed = 11;
  scene.plan.order = scene.plan.look_ahead = 0;
  scene.plan.layers = 1;
  scene.plan.batch = 100;
  scene.plan.least_batches = 2;
  return scene;
}

/// Histories with noise, more of it in the upper layer.
inline GreedyScene scene_with_history_noise() {
  GreedyScene scene = scene_of_different_sizes();
  scene.plan.gaussian.history_noise = 0.3;
  scene.plan.binary.history_noise = 0.5;
  return scene;
}

/// Three people, of 3, 22 and 17 frames; those of few frames are drawn more often.
inline GreedyScene scene_with_rare_people() {
  GreedyScene scene = scene_of_different_sizes();
  scene.plan.groups = {0, 1, 0, 1, 2};
  scene.plan.people_power = 0.25;
  return scene;
}

inline CdSettings settings_of(const reference::CdPlan& plan) {
  return {.gibbs_steps = static_cast<std::size_t>(plan.gibbs_steps),
          .rate = plan.rate,
          .rate_A = plan.rate_A,
          .rate_B = plan.rate_B,
          .momentum = plan.momentum,
          .momentum_from_epoch = static_cast<std::size_t>(plan.momentum_from_epoch),
          .weight_decay = plan.weight_decay,
          .initial_deviation = plan.initial_deviation,
          .history_noise = plan.history_noise,
          .epochs = static_cast<std::size_t>(plan.epochs)};
}

inline LearningSettings settings_of(const reference::GreedyPlan& plan) {
  LearningSettings settings;
  settings.seed = plan.seed;
  settings.order = static_cast<std::size_t>(plan.order);
  settings.hidden = static_cast<std::size_t>(plan.hidden);
  settings.layers = static_cast<std::size_t>(plan.layers);
  settings.mrbm_hidden = static_cast<std::size_t>(plan.mrbm_hidden);
  settings.look_ahead = static_cast<std::size_t>(plan.look_ahead);
  settings.batch = static_cast<std::size_t>(plan.batch);
  settings.least_batches = static_cast<std::size_t>(plan.least_batches);
  settings.people_power = plan.people_power;
  settings.gaussian = settings_of(plan.gaussian);
  settings.binary = settings_of(plan.binary);
  settings.mrbm = {.rate = plan.mrbm.rate,
                   .weight_decay = plan.mrbm.weight_decay,
                   .initial_deviation = plan.mrbm.initial_deviation,
                   .mean_field_steps = static_cast<std::size_t>(plan.mrbm.mean_field_steps),
                   .epochs = static_cast<std::size_t>(plan.mrbm.epochs)};
  return settings;
}

inline Mcdbn train_on_device(Device& device, const GreedyScene& scene,
                             const EpochObserver& observer = {}, const Mcdbn* start = nullptr) {
  const MatrixSource source({{"track", scene.tracks}, {"pose", scene.poses}}, scene.plan.groups);
  return train_greedy(device, source, settings_of(scene.plan), observer, start);
}

inline std::vector<MatrixD> in_double(const std::vector<MatrixF>& clips) {
  std::vector<MatrixD> result;
  for (const MatrixF& clip : clips) result.push_back(clip.cast<double>());
  return result;
}

inline reference::GreedyRun train_on_host(const GreedyScene& scene,
                                          const reference::GreedyMachine* start = nullptr) {
  return reference::train_greedy(scene.plan, in_double(scene.tracks), in_double(scene.poses),
                                 start);
}

inline reference::GreedyMachine machine_in_double(const Mcdbn& model) {
  reference::GreedyMachine machine;
  const auto layers_of = [](const Cdbn& cdbn) {
    std::vector<reference::GreedyLayer> layers;
    for (const Crbm& crbm : cdbn.layers) {
      const CrbmParameters p = crbm.to_host();
      layers.push_back({in_double(p), p.visible_mean.cast<double>()});
    }
    return layers;
  };
  machine.track = layers_of(model.cdbns[0]);
  machine.pose = layers_of(model.cdbns[1]);
  machine.mrbm = in_double(model.mrbm.to_host());
  return machine;
}

/// Every parameter of the machine by name.
inline std::map<std::string, MatrixD> tensors_of(const reference::GreedyMachine& machine) {
  std::map<std::string, MatrixD> tensors;
  const auto add_layers = [&](const std::string& name,
                              const std::vector<reference::GreedyLayer>& layers) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const std::string layer = name + "." + std::to_string(i) + ".";
      tensors[layer + "W"] = layers[i].crbm.weights;
      tensors[layer + "A"] = layers[i].crbm.visible_history;
      tensors[layer + "B"] = layers[i].crbm.hidden_history;
      tensors[layer + "a"] = layers[i].crbm.visible_bias;
      tensors[layer + "b"] = layers[i].crbm.hidden_bias;
      tensors[layer + "visible_mean"] = layers[i].visible_mean;
    }
  };
  add_layers("track", machine.track);
  add_layers("pose", machine.pose);
  for (std::size_t m = 0; m < 2; ++m) {
    tensors["mrbm.W" + std::to_string(m)] = machine.mrbm.weights[m];
    tensors["mrbm.a" + std::to_string(m)] = machine.mrbm.visible_bias[m];
  }
  tensors["mrbm.b"] = machine.mrbm.hidden_bias;
  return tensors;
}

/// All is as in the reference, but for rounding.
inline void check_machine(const Mcdbn& got, const reference::GreedyMachine& want) {
  const auto got_tensors = tensors_of(machine_in_double(got));
  const auto want_tensors = tensors_of(want);
  CHECK(got_tensors.size() == want_tensors.size());
  for (const auto& [name, tensor] : want_tensors) {
    CAPTURE_BOUND(name);
    REQUIRE(got_tensors.count(name) == 1);
    const MatrixD bound = MatrixD::Constant(tensor.rows(), tensor.cols(), kGreedyTolerance);
    CHECK(reference::misfit(got_tensors.at(name), tensor, bound) == "");
  }
}

}  // namespace mcdbn::test
