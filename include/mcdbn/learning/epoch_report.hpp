#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "mcdbn/learning/layer_health.hpp"

namespace mcdbn {

/// Report of one epoch to an observer.
struct EpochReport {
  std::string stage;  ///< a modality and its layer (pose.0), mrbm, fine-tuning
  std::size_t epoch = 0, epochs = 0;
  double loss = 0;  ///< of a unit or, in fine-tuning, weighted: docs/formats.md, metrics.jsonl
  double windows_per_s = 0;             ///< without the time in which kernels were compiled
  double stage_progress = 0;            ///< 0 … 1
  double overall_progress = 0;          ///< 0 … 1, by the stages' own cost
  std::optional<double> held_out_loss;  ///< of the clips held out, fine-tuning only
  /// Share of the time since the last report in which training waited for sequences that are made
  /// on the way, fine-tuning only.
  std::optional<double> waiting_share;
  std::optional<LayerHealth> health;  ///< at a stage's first and last epoch, and every fifth
};
using EpochObserver = std::function<void(const EpochReport&)>;

}  // namespace mcdbn
