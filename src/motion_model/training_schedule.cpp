#include "mcdbn/motion_model/training_schedule.hpp"

#include "corpus/augmented_views.hpp"
#include "corpus/held_out_person.hpp"
#include "learning/random_start.hpp"
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

}  // namespace

TrainingSet make_training_set(const std::vector<LoadedClip>& clips, const TrainingConfig& config) {
  return make_training_set(clips, config, config.seed, config.fine_tuning.steps > 0);
}

TrainingSet make_augmented_views(const std::vector<LoadedClip>& clips, const Modalities& modalities,
                                 const TrainingConfig& config) {
  return make_augmented_views(clips, modalities, config, config.seed);
}

TrainedNetwork fine_tune(Device& device, const Mcdbn& start, const TrainingSet& views,
                         const TrainingConfig& config, const EpochObserver& observer) {
  const SequenceLossMaker make_loss = pose_loss_maker(views.modalities, config.pose_loss);
  const auto person = person_to_hold_out(views, config.hold_out_among);
  if (!person)
    return {
        fine_tune(device, start, ClipSource(views), nullptr, config, make_loss, observer).network,
        {}};
  const TrainingSet others = views_without(views, *person), stranger = views_of(views, *person);
  const ClipSource judges(stranger);
  FineTuned tuned =
      fine_tune(device, start, ClipSource(others), &judges, config, make_loss, observer);
  return {std::move(tuned.network),
          EarlyStopping{clip_names(stranger), tuned.kept->steps, tuned.kept->loss}};
}

TrainedNetwork train_network(Device& device, const TrainingSet& data, std::vector<LoadedClip> clips,
                             const TrainingConfig& config, const EpochObserver& observer) {
  if (config.fine_tuning.steps == 0)
    return {train_greedy(device, ClipSource(data), config, observer), {}};
  const ViewSource views(std::move(clips), data.modalities, config);
  std::vector<Modality> modalities;
  for (const ModalityClips& modality : ClipSource(data).sequences().modalities)
    modalities.push_back({modality.name, modality.dimension(), modality.kind});
  Mcdbn start = random_start(device, modalities, config);
  double done = 0.0;
  if (config.fine_tuning.from_greedy) {
    done = kGreedyShare;
    start = train_greedy(device, views, config, part_of_run(observer, 0.0, done), &start);
  }
  return fine_tune(device, start, views.views(), config, part_of_run(observer, done, 1.0));
}

}  // namespace mcdbn
