#pragma once

#include <functional>
#include <string>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/run_folder.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

struct TrainedRun {
  Model model;
  double training_s = 0;  ///< without reading clips, and before an interruption
};

/// How a training keeps what it has; nothing of the model depends on it.
struct CheckpointSettings {
  double minutes = 5;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    constexpr double kWeek = 7 * 24 * 60;
    visit(Setting{"checkpoint-minutes", within(0, kWeek), "minutes",
                  "time between checkpoints: a crash loses no more work than that; an interruption "
                  "always writes one"},
          self.minutes);
  }
};

/// The observers of a training while it runs.
struct TrainingWatch {
  EpochObserver epoch = {};  ///< after its line is written; may throw to stop
  std::function<void(const std::string&)> warning = {};  ///< what went wrong and is no end
};

/// Trains on clips and sets how the model draws samples.
/// @param data of make_training_set(clips, config)
/// @param start the model that it starts from (training_start.hpp), whose modalities data has;
///        none: random weights
/// @throws ConfigError, DivergenceError
TrainedRun train_model(Device& device, const TrainingSet& data, const ClipStore& clips,
                       const TrainingConfig& config, const EpochObserver& observer = {},
                       const Model* start = nullptr);

/// Trains as train_model() and writes into a run folder: a line of metrics.jsonl for each epoch,
/// checkpoints now and then, and at last the model. A folder with a checkpoint goes on from there,
/// to the same bits on the same device.
/// @param data, clips of the folder's own settings and clips
/// @throws InputError if a file cannot be written, or the checkpoint is of other clips; Interrupted
/// once a checkpoint is written, if that was asked for (base/interruption.hpp)
TrainedRun train_to_folder(Device& device, const TrainingSet& data, const ClipStore& clips,
                           RunFolder& run, const CheckpointSettings& settings = {},
                           const TrainingWatch& watch = {}, const Model* start = nullptr);

}  // namespace mcdbn
