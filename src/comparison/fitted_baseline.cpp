#include "comparison/fitted_baseline.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "comparison/training_views.hpp"
#include "corpus/encoded_clip.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::vector<EncodedClip> encode_training_clips(const Model& model, bool keep_first_frame,
                                               const JointMap& joint_map) {
  require_training_clips(model, "take no baselines");
  std::vector<EncodedClip> clips;
  for (const TrainingClip& clip : model.training_clips)
    clips.push_back(encode_clip(clip.path, model.modalities, model.modalities.camera,
                                keep_first_frame, nullptr, joint_map));
  return clips;
}

}  // namespace

void require_training_clips(const Model& model, std::string_view otherwise) {
  for (const TrainingClip& clip : model.training_clips)
    if (!std::filesystem::exists(clip.path))
      throw InputError(
          fmt::format("{}: a training clip of the model is gone; baselines are fitted on it, so "
                      "put it back or {}",
                      clip.path, otherwise));
}

BaselineLessons clip_lessons(const Model& model, bool keep_first_frame, const JointMap& joint_map) {
  BaselineLessons lessons;
  for (EncodedClip& clip : encode_training_clips(model, keep_first_frame, joint_map)) {
    lessons.tracks.push_back(std::move(clip.track_features));
    lessons.poses.push_back(std::move(clip.pose_features));
  }
  return lessons;
}

BaselineLessons lessons_of(const std::string& name, const Model& model) {
  TestRunOptions run;
  run.baselines = {name};
  add_training_views(model, run);
  BaselineLessons lessons = clip_lessons(model, run.keep_first_frame);
  lessons.view_tracks = std::move(run.view_tracks);
  lessons.view_poses = std::move(run.view_poses);
  return lessons;
}

std::unique_ptr<Baseline> fitted_baseline(const std::string& name, const Model& model,
                                          const BaselineLessons& lessons) {
  const bool has_views = !lessons.view_tracks.empty();
  auto baseline = make_baseline(name, model.network.mrbm.device(), has_views);
  if (has_views && baseline->learns_from_views())
    baseline->fit(lessons.view_tracks, lessons.view_poses);
  else
    baseline->fit(lessons.tracks, lessons.poses);
  return baseline;
}

}  // namespace mcdbn
