#include "mcdbn/motion_model/training_schedule.hpp"

#include <algorithm>

#include "corpus/augmented_views.hpp"
#include "corpus/held_out_person.hpp"
#include "learning/learnt_deviation.hpp"
#include "learning/memory_need.hpp"
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

/// Views of everybody but the person held out, if one is; others wherever `more` makes them.
class Lessons : public SequenceSource {
 public:
  Lessons(const TrainingSet& views, std::optional<std::size_t> held_out, const ViewSource* more)
      : held_out_(held_out), more_(more) {
    take(views);
  }
  SynchronizedClips sequences() const override {
    return ClipSource(others_ ? *others_ : *all_).sequences();
  }
  bool renew(std::size_t round) const override {
    if (more_ == nullptr || !more_->renew(round)) return false;
    take(more_->views());
    return true;
  }

 private:
  void take(const TrainingSet& views) const {
    all_ = &views;
    if (held_out_) others_ = views_without(views, *held_out_);
  }

  std::optional<std::size_t> held_out_;
  const ViewSource* more_;
  mutable const TrainingSet* all_ = nullptr;
  mutable std::optional<TrainingSet> others_;
};

/// @param more makes other views on the way, or none
TrainedNetwork fine_tune_on(Device& device, const Mcdbn& start, const TrainingSet& views,
                            const ViewSource* more, const TrainingConfig& config,
                            const EpochObserver& observer, Checkpoints* checkpoints) {
  const SequenceLossMaker make_loss = pose_loss_maker(views.modalities, config.pose_loss);
  const auto person = person_to_hold_out(views, config.hold_out_among);
  const Lessons lessons(views, person, more);
  std::optional<TrainingSet> stranger;
  if (person) stranger = views_of(views, *person);
  std::optional<ClipSource> judges;
  if (stranger) judges.emplace(*stranger);
  FineTuned tuned = fine_tune(device, start, lessons, judges ? &*judges : nullptr, config,
                              make_loss, observer, checkpoints);
  // A round of its own: views that nothing was learnt from, the same after a training that was
  // interrupted.
  if (const std::size_t lasts = config.fine_tuning.new_views_every; lasts > 0)
    lessons.renew((config.fine_tuning.steps - 1) / lasts + 1);
  std::optional<SynchronizedClips> unseen;
  if (judges) unseen = judges->sequences();
  tuned.network.deviation =
      learnt_deviation(tuned.network, lessons.sequences(), unseen ? &*unseen : nullptr);
  TrainedNetwork trained{std::move(tuned.network), {}};
  if (stranger)
    trained.early_stopping =
        EarlyStopping{clip_names(*stranger), tuned.kept->steps, tuned.kept->loss};
  return trained;
}

/// What would only be found out in the middle of the training.
void check_before(const DeviceInfo& device, const TrainingSet& data, const TrainingConfig& config) {
  const bool tunes = config.fine_tuning.steps > 0;
  if (!tunes || config.fine_tuning.from_greedy) {
    Eigen::Index longest = 0;
    for (const MatrixF& pose : data.poses) longest = std::max(longest, pose.rows());
    check_window(static_cast<std::size_t>(longest), config);
  }
  std::vector<std::size_t> dimensions;
  for (const ModalityClips& modality : ClipSource(data).sequences().modalities)
    dimensions.push_back(modality.dimension());
  const auto frames = static_cast<double>(data.frames());
  check_memory(memory_need(dimensions, tunes ? frames_of_views(frames, config) : frames, config),
               device, config);
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
                         const TrainingConfig& config, const EpochObserver& observer,
                         Checkpoints* checkpoints) {
  return fine_tune_on(device, start, views, nullptr, config, observer, checkpoints);
}

TrainedNetwork train_network(Device& device, const TrainingSet& data, std::vector<LoadedClip> clips,
                             const TrainingConfig& config, const EpochObserver& observer,
                             Checkpoints* checkpoints) {
  check_before(device.info(), data, config);
  if (config.fine_tuning.steps == 0)
    return {train_greedy(device, ClipSource(data), config, observer, nullptr, checkpoints), {}};
  const ViewSource views(std::move(clips), data.modalities, config);
  std::vector<Modality> modalities;
  for (const ModalityClips& modality : ClipSource(data).sequences().modalities)
    modalities.push_back({modality.name, modality.dimension(), modality.kind});
  Mcdbn start = random_start(device, modalities, config);
  double done = 0.0;
  if (config.fine_tuning.from_greedy) {
    done = kGreedyShare;
    start =
        train_greedy(device, views, config, part_of_run(observer, 0.0, done), &start, checkpoints);
  }
  return fine_tune_on(device, start, views.views(), &views, config,
                      part_of_run(observer, done, 1.0), checkpoints);
}

}  // namespace mcdbn
