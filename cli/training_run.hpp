#pragma once

#include <filesystem>
#include <vector>

#include "commands.hpp"
#include "interrupt.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn::cli {

struct TrainedRun {
  Model model;
  double training_s = 0;  ///< of the schedule alone, without reading clips
};

/// Trains on these clips and writes the run folder: model.safetensors, metrics.jsonl, config.toml.
/// @throws InputError, ConfigError, DivergenceError, Interrupted
TrainedRun train_to_folder(const CommandContext& context, Device& device,
                           const std::vector<std::filesystem::path>& clips,
                           const TrainingConfig& config, const std::filesystem::path& run,
                           const InterruptGuard& interrupt);

}  // namespace mcdbn::cli
