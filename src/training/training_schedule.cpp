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
  const TrainingSet views = make_augmented_views(files, data.modalities, config);
  Mcdbn start = random_start(device, static_cast<std::size_t>(data.tracks.front().cols()),
                             static_cast<std::size_t>(data.poses.front().cols()), config);
  double greedy_share = 0.0;  // of the time, about
  if (config.joint.from_greedy) {
    greedy_share = 0.1;
    start = train_greedy(device, views, config, part_of_run(observer, 0.0, greedy_share), &start);
  }
  return train_joint(device, start, views, config, part_of_run(observer, greedy_share, 1.0));
}

}  // namespace mcdbn
