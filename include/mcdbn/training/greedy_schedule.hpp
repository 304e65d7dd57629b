#pragma once

#include <functional>
#include <optional>
#include <string>

#include "mcdbn/model/mcdbn.hpp"
#include "mcdbn/training/config.hpp"
#include "mcdbn/training/layer_health.hpp"
#include "mcdbn/training/training_set.hpp"

namespace mcdbn {

/// What an observer learns of each epoch.
struct EpochReport {
  std::string stage;  ///< pose.0, pose.1, track.0, track.1, mrbm, joint
  std::size_t epoch = 0, epochs = 0;
  double loss = 0;  ///< mean squared reconstruction error of a unit, or cross-entropy of a unit
  double windows_per_s = 0;
  double stage_progress = 0;            ///< 0 … 1
  double overall_progress = 0;          ///< 0 … 1, by the stages' own cost
  std::optional<double> held_out_loss;  ///< of the person held out, joint stage only
  std::optional<LayerHealth> health;    ///< at a stage's first and last epoch, and every fifth
};
using EpochObserver = std::function<void(const EpochReport&)>;

/// Algorithm 1: the 3D CDBN layer by layer, the 2D CDBN, then the MRBM on their codes.
/// The observer may throw to stop.
/// @param start weights to start from; nothing: small random ones, as the settings' deviations say
/// @throws DivergenceError saying what to lower
Mcdbn train_greedy(Device& device, const TrainingSet& data, const TrainingConfig& config,
                   const EpochObserver& observer = {}, const Mcdbn* start = nullptr);

/// One layer of Algorithm 1: CD-k on every window of `visible` for settings.epochs epochs.
/// @param initial its visible_mean is taken from `visible`
/// @param stream separates this layer's random numbers from those of the others
Crbm train_crbm(Device& device, const Sequences& visible, CrbmParameters initial,
                const CdSettings& settings, const TrainingConfig& config, std::uint16_t stream,
                const EpochObserver& observer = {}, const std::string& stage = "crbm");

/// The MRBM by multi-prediction on codes whose rows belong to the same frames.
Mrbm train_mrbm(Device& device, const Sequences& track, const Sequences& pose,
                const MrbmParameters& initial, const TrainingConfig& config, std::uint16_t stream,
                const EpochObserver& observer = {});

}  // namespace mcdbn
