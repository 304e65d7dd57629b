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

BaselineTrainingData clip_training_data(const Model& model, bool keep_first_frame,
                                        const JointMap& joint_map) {
  BaselineTrainingData data;
  for (EncodedClip& clip : encode_training_clips(model, keep_first_frame, joint_map)) {
    data.tracks.push_back(std::move(clip.track_features));
    data.poses.push_back(std::move(clip.pose_features));
  }
  return data;
}

BaselineTrainingData training_data_of(const std::string& name, const Model& model) {
  TestRunOptions run;
  run.baselines = {name};
  add_training_views(model, run);
  BaselineTrainingData data = clip_training_data(model, run.keep_first_frame);
  data.view_tracks = std::move(run.view_tracks);
  data.view_poses = std::move(run.view_poses);
  return data;
}

std::unique_ptr<Baseline> fitted_baseline(const std::string& name, const Model& model,
                                          const BaselineTrainingData& data) {
  const bool has_views = !data.view_tracks.empty();
  auto baseline = make_baseline(name, model.network.mrbm.device(), has_views);
  if (has_views && baseline->learns_from_views())
    baseline->fit(data.view_tracks, data.view_poses);
  else
    baseline->fit(data.tracks, data.poses);
  return baseline;
}

}  // namespace mcdbn
