#include "mcdbn/training/training_schedule.hpp"

#include "mcdbn/training/augmented_views.hpp"
#include "mcdbn/training/joint_fine_tuning.hpp"
#include "mcdbn/training/joint_start.hpp"

namespace mcdbn {
namespace {

/// An observer of one stage that shows it as the part `from` … `to` of the run.
EpochObserver part_of_run(const EpochObserver& observer, double from, double to) {
  if (!observer) return {};
  return [=](EpochReport report) {
    report.overall_progress = from + (to - from) * report.overall_progress;
    observer(report);
  };
}

}  // namespace

TrainedNetwork train_network(Device& device, const TrainingSet& data,
                             const std::vector<std::filesystem::path>& files,
                             const TrainingConfig& config, const EpochObserver& observer) {
  if (config.joint.steps == 0) return {train_greedy(device, data, config, observer), {}};
  const double greedy_share = config.joint.from_greedy ? 0.2 : 0.0;  // of the time, about
  const Mcdbn start =
      config.joint.from_greedy
          ? sized_for_joint_stage(
                device,
                train_greedy(device, data, config, part_of_run(observer, 0.0, greedy_share)),
                config)
          : random_start(device, static_cast<std::size_t>(data.tracks.front().cols()),
                         static_cast<std::size_t>(data.poses.front().cols()), config);
  return train_joint(device, start, make_augmented_views(files, data.modalities, config), config,
                     part_of_run(observer, greedy_share, 1.0));
}

}  // namespace mcdbn
