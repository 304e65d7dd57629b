#pragma once

#include <filesystem>
#include <vector>

#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

struct TrainedRun {
  Model model;
  double training_s = 0;  ///< without reading clips
};

/// Trains on clips and writes a run folder: config.toml, the settings; metrics.jsonl, a line for
/// each epoch; and at last model.safetensors.
/// @param data of make_training_set(clips, config)
/// @param clips gone once the views of them are made
/// @param observer hears of each epoch after it has its line; may throw to stop
/// @throws InputError if a file cannot be written, ConfigError, DivergenceError
TrainedRun train_to_folder(Device& device, const TrainingSet& data, std::vector<LoadedClip> clips,
                           const TrainingConfig& config, const std::filesystem::path& run,
                           const EpochObserver& observer = {});

}  // namespace mcdbn
