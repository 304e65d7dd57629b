#include "mcdbn/learning/machine_fit.hpp"

#include <fmt/format.h>

#include "base/random_streams.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"

namespace mcdbn {
namespace {

/// Phase of the first weights' draws: train_crbm's own are others.
constexpr std::uint16_t kWeightPhase = 0x7100;

LearningSettings learning_of(const MachineSettings& settings) {
  LearningSettings learning;
  learning.seed = settings.seed;
  learning.batch = settings.batch;
  learning.least_batches = settings.least_batches;
  return learning;
}

/// The same reports, as part `layer` of `layers` of the whole run.
EpochObserver part_of_run(const EpochObserver& observer, std::size_t layer, std::size_t layers) {
  if (!observer) return {};
  return [=](EpochReport report) {
    report.overall_progress =
        (static_cast<double>(layer) + report.stage_progress) / static_cast<double>(layers);
    observer(report);
  };
}

}  // namespace

Cdbn fit_stack(Device& device, const Sequences& data, VisibleKind kind, std::size_t order,
               std::size_t layers, const MachineSettings& settings, const EpochObserver& observer) {
  settings.validate();
  Cdbn stack;
  Sequences code = data;
  for (std::size_t i = 0; i < layers; ++i) {
    const CrbmShape shape{code.values.columns(), settings.hidden, order,
                          i == 0 ? kind : VisibleKind::binary};
    const CdSettings& rule =
        shape.kind == VisibleKind::gaussian ? settings.gaussian : settings.binary;
    const auto stream = static_cast<std::uint16_t>(random_streams::layers_of(0) + i);
    stack.layers.push_back(
        train_crbm(device, code,
                   CrbmParameters::random(shape, rule.initial_deviation,
                                          {settings.seed, 0, stream, kWeightPhase}),
                   rule, learning_of(settings), stream, part_of_run(observer, i, layers),
                   fmt::format("layer.{}", i)));
    if (i + 1 < layers) code = up_pass(stack.layers.back(), code);
  }
  return stack;
}

}  // namespace mcdbn
