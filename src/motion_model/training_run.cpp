#include "mcdbn/motion_model/training_run.hpp"

#include <chrono>

#include "base/text_file.hpp"
#include "learning/metrics_log.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/sample_calibration.hpp"

namespace mcdbn {

TrainedRun train_to_folder(Device& device, const TrainingSet& data, std::vector<LoadedClip> clips,
                           const TrainingConfig& config, const std::filesystem::path& run,
                           const EpochObserver& observer) {
  using Clock = std::chrono::steady_clock;
  config.validate();
  make_folder(run);
  write_text_file(run / "config.toml", settings_toml(config));
  MetricsLog metrics(run / "metrics.jsonl");
  const auto start = Clock::now();
  auto [network, stopped] =
      train_network(device, data, std::move(clips), config, [&](const EpochReport& report) {
        metrics.add(report);
        if (observer) observer(report);
      });
  if (config.fine_tuning.steps > 0)
    network.sampling = calibrated_sampling(network, data.modalities, data.tracks, data.poses);
  const double training_s = std::chrono::duration<double>(Clock::now() - start).count();
  TrainedRun trained{
      {std::move(network), data.modalities, data.clips, settings_json(config), std::move(stopped)},
      training_s};
  save_model(run / "model.safetensors", trained.model);
  return trained;
}

}  // namespace mcdbn
