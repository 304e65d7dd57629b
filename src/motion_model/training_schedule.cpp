#include "mcdbn/motion_model/training_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "corpus/augmented_views.hpp"
#include "corpus/held_out_person.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/memory_need.hpp"
#include "learning/random_start.hpp"
#include "learning/resumable_training.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion_model/pose_fine_tuning.hpp"
#include "motion_model/resumable_training.hpp"

namespace mcdbn {
namespace {

/// The greedy stages' share of the time of a default run, where fine-tuning follows, for the
/// progress shown. On 43 CMU walks fine-tuning took 405 of 456 s, reading clips included.
constexpr double kGreedyShare = 0.1;

/// An observer of one stage that shows it as the part `from` … `to` of the run.
EpochObserver part_of_run(const EpochObserver& observer, double from, double to) {
  if (!observer) return {};
  return [=](EpochReport report) {
    report.overall_progress = from + (to - from) * report.overall_progress;
    observer(report);
  };
}

/// The greedy stages as the beginning of a run, if the settings ask for them.
Mcdbn greedy_start(Device& device, Checkpoints* checkpoints, const SequenceSource& source,
                   Mcdbn start, const TrainingConfig& config, const EpochObserver& observer) {
  if (!config.fine_tuning.from_greedy) return start;
  return train_greedy(device, checkpoints, source, config, part_of_run(observer, 0.0, kGreedyShare),
                      &start);
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

std::optional<HeldOutPerson> held_out_person(const std::optional<TrainingSet>& views,
                                             const ClipStore& clips, const TrainingConfig& config) {
  const auto person = person_to_hold_out(clips, config.hold_out_among);
  if (!person || !views) return {};
  return HeldOutPerson{*views, clip_names(clips, *person)};
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
  check_memory(dimensions, kept, config, device);
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

TrainedNetwork train_network(Device& device, const TrainingSet& data, const ClipStore& clips,
                             const TrainingConfig& config, const EpochObserver& observer,
                             const Mcdbn* start) {
  return train_network(device, nullptr, data, clips, config, observer, start);
}

TrainedNetwork train_network(Device& device, Checkpoints* checkpoints, const TrainingSet& data,
                             const ClipStore& clips, const TrainingConfig& config,
                             const EpochObserver& observer, const Mcdbn* start) {
  check_before(device.info(), data, clips, config);
  if (config.fine_tuning.steps == 0)
    return {train_greedy(device, checkpoints, ClipSource(data), config, observer), {}};
  std::vector<Modality> modalities;
  for (const ModalityClips& modality : ClipSource(data).sequences().modalities)
    modalities.push_back({modality.name, modality.dimension(), modality.kind});
  Mcdbn network = start != nullptr ? *start : random_start(device, modalities, config);
  const EpochObserver tuning =
      part_of_run(observer, config.fine_tuning.from_greedy ? kGreedyShare : 0.0, 1.0);
  if (learns_from_fresh_views(clips, config)) {
    const FreshViewSource views(clips, data, config);
    network = greedy_start(device, checkpoints, views, std::move(network), config, observer);
    const auto held_out = held_out_person(views.held_out_views(), clips, config);
    // Views that nothing was learnt from, the same after a training that was interrupted.
    return fine_tune_on_poses(device, checkpoints, network, views, held_out ? &*held_out : nullptr,
                              data.modalities, config, tuning,
                              [&] { views.renew(config.fine_tuning.steps + views.lifetime()); });
  }
  const ViewSource views(clips, data, config);
  network = greedy_start(device, checkpoints, views, std::move(network), config, observer);
  const auto held_out = held_out_person(views.held_out_views(), clips, config);
  return fine_tune_on_poses(device, checkpoints, network, views, held_out ? &*held_out : nullptr,
                            data.modalities, config, tuning);
}

}  // namespace mcdbn
