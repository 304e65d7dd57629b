#include "comparison/training_views.hpp"

#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace mcdbn {

void add_training_views(const Model& model, TestRunOptions& run) {
  const TrainingConfig config = settings_from_json(model.config);
  if (config.fine_tuning.steps == 0) return;
  std::vector<std::filesystem::path> files;
  for (const TrainingClip& clip : model.training_clips) {
    if (!std::filesystem::exists(clip.path)) return;
    if (files.empty() || files.back() != clip.path) files.emplace_back(clip.path);
  }
  TrainingSet views =
      make_augmented_views(load_clips(files, config.keep_first_frame), model.modalities, config);
  run.view_tracks = std::move(views.tracks);
  run.view_poses = std::move(views.poses);
}

}  // namespace mcdbn
