#include "mcdbn/motion_model/training_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "corpus/augmented_views.hpp"
#include "corpus/clip_pieces.hpp"
#include "corpus/held_out_person.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/learnt_deviation.hpp"
#include "learning/memory_need.hpp"
#include "learning/random_start.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "motion_model/pose_loss.hpp"

namespace mcdbn {
namespace {

/// Of the time that a default run takes the greedy stages' part, where fine-tuning follows: what
/// progress shows. On 43 CMU walks fine-tuning took 405 of 456 s, reading clips included.
constexpr double kGreedyShare = 0.1;

/// An observer of one stage that shows it as the part `from` … `to` of the run.
EpochObserver part_of_run(const EpochObserver& observer, double from, double to) {
  if (!observer) return {};
  return [=](EpochReport report) {
    report.overall_progress = from + (to - from) * report.overall_progress;
    observer(report);
  };
}

SequenceLossMaker pose_loss_maker(const Modalities& modalities, const PoseLossWeights& weights) {
  return [&modalities, weights](Device& device, const SequenceWindows& windows) {
    return std::make_unique<PoseLoss>(device, modalities, windows, weights);
  };
}

/// Fine-tuning, and how far off the answers are.
/// @param source to learn from
/// @param held_out_views of the person held out, or none
/// @param before_deviation is called before the answers' deviation is learnt from the source
TrainedNetwork fine_tune_on_source(Device& device, const Mcdbn& start, const SequenceSource& source,
                                   const TrainingSet* held_out_views, const Modalities& modalities,
                                   const TrainingConfig& config, const EpochObserver& observer,
                                   Checkpoints* checkpoints,
                                   const std::function<void()>& before_deviation = {}) {
  std::optional<ClipSource> held_out_source;
  if (held_out_views != nullptr) held_out_source.emplace(*held_out_views);
  FineTuned tuned =
      fine_tune(device, start, source, held_out_source ? &*held_out_source : nullptr, config,
                pose_loss_maker(modalities, config.pose_loss), observer, checkpoints);
  if (before_deviation) before_deviation();
  std::optional<SynchronizedClips> held_out_clips;
  if (held_out_source) held_out_clips = held_out_source->sequences();
  tuned.network.deviation = learnt_deviation(tuned.network, source.sequences(),
                                             held_out_clips ? &*held_out_clips : nullptr);
  TrainedNetwork trained{std::move(tuned.network), {}};
  if (held_out_views != nullptr)
    trained.early_stopping =
        EarlyStopping{clip_names(*held_out_views), tuned.kept->steps, tuned.kept->loss};
  return trained;
}

/// The greedy stages as the beginning of a run, if the settings ask for them.
Mcdbn greedy_start(Device& device, const SequenceSource& source, Mcdbn start,
                   const TrainingConfig& config, const EpochObserver& observer,
                   Checkpoints* checkpoints) {
  if (!config.fine_tuning.from_greedy) return start;
  return train_greedy(device, source, config, part_of_run(observer, 0.0, kGreedyShare), &start,
                      checkpoints);
}

/// Hidden limbs teach no deviation.
/// @throws ConfigError
void check_deviation(std::size_t dimension, const TrainingConfig& config) {
  const AugmentationSettings& views = config.augment;
  if (views.missing == 0 && views.detector == 0) return;
  if (!learns_deviation(layer_shapes(dimension, config).front(), config.gaussian)) return;
  throw ConfigError(fmt::format(
      "`gaussian.deviation-rate` (now {:g}) is learnt from limbs that are all seen, and "
      "`augment.missing` (now {:g}) and `augment.detector` ({:g}) hide some: set it, or both of "
      "these, to 0",
      config.gaussian.deviation_rate, views.missing, views.detector));
}

/// What would only be found out in the middle of the training.
void check_before(const DeviceInfo& device, const TrainingSet& data, const ClipStore& clips,
                  const TrainingConfig& config) {
  const bool tunes = config.fine_tuning.steps > 0;
  if (!tunes || config.fine_tuning.from_greedy) {
    Eigen::Index longest = 0;
    for (const MatrixF& pose : data.poses) longest = std::max(longest, pose.rows());
    check_window(static_cast<std::size_t>(longest), config);
  }
  std::vector<std::size_t> dimensions;
  for (const ModalityClips& modality : ClipSource(data).sequences().modalities)
    dimensions.push_back(modality.dimension());
  if (tunes && config.fine_tuning.from_greedy) check_deviation(dimensions[kTrack], config);
  const auto frames = static_cast<double>(data.frames());
  const double kept =
      !tunes ? frames
      : learns_from_fresh_views(clips, config)
          ? frames_of_pieces(config) * static_cast<double>(fresh_views_at_once(clips, config))
          : frames_of_views(frames, config);
  check_memory(memory_need(dimensions, kept, config), device, config);
}

}  // namespace

TrainingSet make_training_set(const ClipStore& clips, const TrainingConfig& config) {
  return make_training_set(clips, config, config.seed, config.fine_tuning.steps > 0,
                           person_to_hold_out(clips, config.hold_out_among));
}

TrainingSet make_training_set(const ClipStore& clips, const Modalities& modalities,
                              const TrainingConfig& config) {
  return encoded_training_set(clips, modalities, config, config.fine_tuning.steps > 0,
                              person_to_hold_out(clips, config.hold_out_among));
}

TrainingSet make_augmented_views(const ClipStore& clips, const Modalities& modalities,
                                 const TrainingConfig& config) {
  return make_augmented_views(clips, modalities, config, config.seed, {},
                              person_to_hold_out(clips, config.hold_out_among));
}

TrainedNetwork fine_tune_on_views(Device& device, const Mcdbn& start, const TrainingSet& views,
                                  const TrainingConfig& config, const EpochObserver& observer,
                                  Checkpoints* checkpoints) {
  std::optional<TrainingSet> others, held_out_views;
  if (const auto person = person_to_hold_out(views, config.hold_out_among)) {
    others = views_without(views, *person);
    held_out_views = views_of(views, *person);
  }
  return fine_tune_on_source(device, start, ClipSource(others ? *others : views),
                             held_out_views ? &*held_out_views : nullptr, views.modalities, config,
                             observer, checkpoints);
}

TrainedNetwork train_network(Device& device, const TrainingSet& data, const ClipStore& clips,
                             const TrainingConfig& config, const EpochObserver& observer,
                             Checkpoints* checkpoints, const Mcdbn* from) {
  check_before(device.info(), data, clips, config);
  if (config.fine_tuning.steps == 0)
    return {train_greedy(device, ClipSource(data), config, observer, nullptr, checkpoints), {}};
  std::vector<Modality> modalities;
  for (const ModalityClips& modality : ClipSource(data).sequences().modalities)
    modalities.push_back({modality.name, modality.dimension(), modality.kind});
  Mcdbn start = from != nullptr ? *from : random_start(device, modalities, config);
  const EpochObserver tuning =
      part_of_run(observer, config.fine_tuning.from_greedy ? kGreedyShare : 0.0, 1.0);
  if (learns_from_fresh_views(clips, config)) {
    const FreshViewSource views(clips, data, config);
    start = greedy_start(device, views, std::move(start), config, observer, checkpoints);
    const auto& held_out_views = views.held_out_views();
    // Views that nothing was learnt from, the same after a training that was interrupted.
    return fine_tune_on_source(device, start, views, held_out_views ? &*held_out_views : nullptr,
                               data.modalities, config, tuning, checkpoints,
                               [&] { views.renew(config.fine_tuning.steps + views.lifetime()); });
  }
  const ViewSource views(clips, data, config);
  start = greedy_start(device, views, std::move(start), config, observer, checkpoints);
  const auto& held_out_views = views.held_out_views();
  return fine_tune_on_source(device, start, views, held_out_views ? &*held_out_views : nullptr,
                             data.modalities, config, tuning, checkpoints);
}

}  // namespace mcdbn
