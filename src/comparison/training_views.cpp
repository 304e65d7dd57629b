#include "comparison/training_views.hpp"

#include <algorithm>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace mcdbn {
namespace {

bool any_learns_from_views(const std::vector<std::string>& baselines, Device& device) {
  return std::ranges::any_of(baselines, [&](const std::string& name) {
    return make_baseline(name, device, false)->learns_from_views();
  });
}

}  // namespace

void add_training_views(const Model& model, TestRunOptions& run) {
  if (!any_learns_from_views(run.baselines, model.network.mrbm.device())) return;
  const TrainingConfig config = settings_from_json(model.config);
  if (config.fine_tuning.steps == 0) return;
  std::vector<std::filesystem::path> files;
  std::vector<const TrainingClip*> recorded;
  for (const TrainingClip& clip : model.training_clips) {
    if (!std::filesystem::exists(clip.path)) return;
    if (!files.empty() && files.back() == clip.path) continue;
    files.emplace_back(clip.path);
    recorded.push_back(&clip);
  }
  std::vector<LoadedClip> clips = load_clips(files, config.keep_first_frame);
  for (std::size_t i = 0; i < clips.size(); ++i) {
    clips[i].clip.person = recorded[i]->person;
    clips[i].clip.action = recorded[i]->action;
  }
  try {
    for (LoadedClip& clip : clips)
      clip.motion = for_skeleton(std::move(clip.motion), model.modalities.pose_features.skeleton(),
                                 run.joint_map);
  } catch (const InputError&) {  // its roles came from a joint map that is not given here
    return;
  }
  const ClipStore store(std::move(clips));
  TrainingSet views = learns_from_fresh_views(store, config)
                          ? some_fresh_views(store, model.modalities, config)
                          : make_augmented_views(store, model.modalities, config);
  run.view_tracks = std::move(views.tracks);
  run.view_poses = std::move(views.poses);
}

}  // namespace mcdbn
