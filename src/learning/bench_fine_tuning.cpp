#include <memory>

#include "learning/bench_steps.hpp"
#include "learning/bench_work.hpp"
#include "learning/fine_tuner.hpp"
#include "learning/squared_loss.hpp"

namespace mcdbn {
namespace {

constexpr std::size_t kTrack = 43, kPose = 154;

/// Standard normal frames of both modalities.
MatrixSource random_clips() {
  constexpr std::size_t kFrames = 4096;
  const auto clip = [](std::size_t columns, std::uint32_t step) {
    return CrbmParameters::random({kFrames, columns}, 1.0, {1, step, 7, 0}).W;
  };
  return MatrixSource(
      std::vector<ModalityMatrices>{{"track", {clip(kTrack, 0)}}, {"pose", {clip(kPose, 1)}}});
}

Mcdbn random_network(Device& device, const LearningSettings& settings) {
  constexpr double kDeviation = 0.01;
  const auto cdbn = [&](std::size_t visible) {
    Cdbn result;
    result.layers.emplace_back(
        device, CrbmParameters::random({visible, settings.hidden, settings.order}, kDeviation, {}));
    return result;
  };
  const MrbmShape shape{{{"track", settings.hidden}, {"pose", settings.hidden}},
                        settings.mrbm_hidden};
  Mcdbn network{{}, Mrbm(device, MrbmParameters::random(shape, kDeviation, {}))};
  network.cdbns.push_back(cdbn(kTrack));
  network.cdbns.push_back(cdbn(kPose));
  network.look_ahead = settings.look_ahead;
  return network;
}

BenchStep fine_tuning_step(Device& device, std::size_t directions) {
  struct State {
    LearningSettings settings;
    MatrixSource clips = random_clips();
    Mcdbn network;
    SequenceWindows windows;
    FineTuner tuner;
    std::size_t step = 0;
    explicit State(Device& device)
        : network(random_network(device, settings)),
          windows(sequence_windows(network, settings.fine_tuning)),
          tuner(device, network, clips.sequences(), windows, settings,
                [](Device& where, const SequenceWindows& which) {
                  return std::make_unique<SquaredLoss>(where, which, 1.0);
                }) {}
  };
  const auto state = std::make_shared<State>(device);
  const SequenceWindows& windows = state->windows;
  double flops = 0;
  for (std::size_t absent = 2; absent-- > 2 - directions;)
    flops += unrolled_flops(state->network, absent, windows, state->settings.fine_tuning);
  return {{{"layer", "fine_tuning"},
           {"windows", windows.count},
           {"window_frames", windows.frames},
           {"directions", directions}},
          flops,
          // Both directions take part in every so many steps.
          [state, directions] {
            state->step += FineTuner::kReverseEvery;
            state->tuner.step(state->step % state->settings.fine_tuning.steps + directions % 2);
          }};
}

}  // namespace

std::vector<BenchStepMaker> fine_tuning_steps() {
  std::vector<BenchStepMaker> makers;
  for (const std::size_t directions : {1U, 2U})
    makers.push_back(
        {"fine_tuning", [=](Device& device) { return fine_tuning_step(device, directions); }});
  return makers;
}

}  // namespace mcdbn
