#include "mcdbn/motion_model/training_run.hpp"

#include <fmt/format.h>

#include <chrono>

#include "base/user_cache.hpp"
#include "learning/metrics_log.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_start.hpp"
#include "motion_model/resumable_training.hpp"
#include "motion_model/sample_calibration.hpp"

namespace mcdbn {
namespace {

/// Tells whether clips are those that a checkpoint was trained on; in halves that are exact
/// numbers.
struct ClipsDigest {
  std::uint32_t low, high;

  explicit ClipsDigest(const TrainingSet& data) {
    std::string all;
    for (const TrainingClip& clip : data.clips) all += clip.fingerprint;
    const std::uint64_t digest = fnv1a(all);
    low = static_cast<std::uint32_t>(digest);
    high = static_cast<std::uint32_t>(digest >> 32);
  }
  void visit_state(TrainingState& state, const RunFolder& run) {
    const ClipsDigest now = *this;
    state.number("clips.low", low);
    state.number("clips.high", high);
    if (low != now.low || high != now.high)
      throw InputError(
          fmt::format("{}: the clips are not those that the training was begun with; bring them "
                      "back, or train anew",
                      run.unfinished().string()));
  }
};

}  // namespace

TrainedRun train_model(Device& device, const TrainingSet& data, const ClipStore& clips,
                       const TrainingConfig& config, const EpochObserver& observer,
                       const Model* start) {
  return train_model(device, nullptr, data, clips, config, observer, start);
}

TrainedRun train_model(Device& device, Checkpoints* checkpoints, const TrainingSet& data,
                       const ClipStore& clips, const TrainingConfig& config,
                       const EpochObserver& observer, const Model* start) {
  using Clock = std::chrono::steady_clock;
  config.validate();
  if (start != nullptr) check_start(*start, config);
  const auto begin = Clock::now();
  auto [network, stopped] = train_network(device, checkpoints, data, clips, config, observer,
                                          start != nullptr ? &start->network : nullptr);
  if (config.fine_tuning.steps > 0)
    network.sampling = calibrated_sampling(network, data.modalities, data.tracks, data.poses);
  const double training_s = std::chrono::duration<double>(Clock::now() - begin).count();
  Model model{std::move(network), data.modalities, {}, settings_json(config), std::move(stopped)};
  // What the model to start from has seen is no test for this one either.
  if (start != nullptr) {
    model.training_clips = start->training_clips;
    std::erase_if(model.training_clips,
                  [&](const TrainingClip& clip) { return is_among(data.clips, clip); });
  }
  model.training_clips.insert(model.training_clips.end(), data.clips.begin(), data.clips.end());
  return {std::move(model), training_s};
}

TrainedRun train_to_folder(Device& device, const TrainingSet& data, const ClipStore& clips,
                           RunFolder& run, const CheckpointSettings& settings,
                           const TrainingWatch& watch, const Model* start) {
  ClipsDigest digest(data);
  std::optional<MetricsLog> metrics;
  std::uint64_t metrics_bytes = 0;
  Checkpoints::Options options;
  options.folder = run.unfinished();
  options.every = std::chrono::duration<double>(60 * settings.minutes);
  if (watch.warning) options.warn = watch.warning;
  options.extra_state = [&](TrainingState& state) {
    if (metrics) metrics_bytes = metrics->bytes();
    state.number("metrics.bytes", metrics_bytes);
    digest.visit_state(state, run);
  };
  Checkpoints checkpoints(options);
  metrics.emplace(run.unfinished() / "metrics.jsonl", metrics_bytes);
  TrainedRun trained = train_model(
      device, &checkpoints, data, clips, run.config(),
      [&](const EpochReport& report) {
        metrics->add(report);
        if (watch.epoch) watch.epoch(report);
      },
      start);
  trained.model.started_from = run.started_from();
  run.complete(trained.model);
  return trained;
}

}  // namespace mcdbn
