#include "motion_model/pose_fine_tuning.hpp"

#include <memory>

#include "learning/learnt_deviation.hpp"
#include "learning/resumable_training.hpp"
#include "motion_model/pose_loss.hpp"

namespace mcdbn {

TrainedNetwork fine_tune_on_poses(Device& device, Checkpoints* checkpoints, const Mcdbn& start,
                                  const SequenceSource& source, const HeldOutPerson* held_out,
                                  const Modalities& modalities, const TrainingConfig& config,
                                  const EpochObserver& observer,
                                  const std::function<void()>& before_deviation) {
  std::optional<ClipSource> held_out_source;
  if (held_out != nullptr) held_out_source.emplace(held_out->views);
  const SequenceLossMaker pose_loss = [&](Device& on, const SequenceWindows& windows) {
    return std::make_unique<PoseLoss>(on, modalities, windows, config.pose_loss);
  };
  FineTuned tuned =
      fine_tune(device, checkpoints, start, source, held_out_source ? &*held_out_source : nullptr,
                config, pose_loss, observer);
  if (before_deviation) before_deviation();
  std::optional<SynchronizedClips> held_out_clips;
  if (held_out_source) held_out_clips = held_out_source->sequences();
  tuned.network.deviation = learnt_deviation(tuned.network, source.sequences(),
                                             held_out_clips ? &*held_out_clips : nullptr);
  TrainedNetwork trained{std::move(tuned.network), {}};
  if (held_out != nullptr)
    trained.early_stopping = EarlyStopping{held_out->clips, tuned.kept->steps, tuned.kept->loss};
  return trained;
}

}  // namespace mcdbn
