#include "mcdbn/regeneration/test_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mcdbn/baselines/baseline.hpp"
#include "mcdbn/errors.hpp"
#include "mcdbn/evaluation/pearson.hpp"

namespace mcdbn {
namespace {

bool was_trained_on(const Model& model, const std::filesystem::path& file) {
  const std::string fingerprint = identify_clip(file).fingerprint;
  return std::any_of(model.training_clips.begin(), model.training_clips.end(),
                     [&](const TrainingClip& clip) { return clip.fingerprint == fingerprint; });
}

/// Joints worth judging: not the root, not those that stand where their parent stands.
std::vector<int> distinct_joints(const Skeleton& skeleton, int root) {
  std::vector<int> joints;
  const TrackFeatures tracked = TrackFeatures::for_skeleton(skeleton, root);
  for (const std::string& name : tracked.joint_names()) joints.push_back(skeleton.find(name));
  return joints;
}

/// Root first, then the distinct joints, root-relative in mm. @return [frames x 3·joints]
MatrixD judged_positions(const Motion& motion, int root) {
  const MatrixD all = root_relative_positions_mm(motion, root);
  const std::vector<int> joints = distinct_joints(motion.skeleton, root);
  MatrixD positions(all.rows(), 3 * static_cast<Eigen::Index>(joints.size() + 1));
  positions.leftCols(3) = all.middleCols(3 * root, 3);
  for (std::size_t i = 0; i < joints.size(); ++i)
    positions.middleCols(3 * static_cast<Eigen::Index>(i + 1), 3) =
        all.middleCols(3 * joints[i], 3);
  return positions;
}

std::vector<EncodedClip> encode_training_clips(const Model& model, const TestRunOptions& options) {
  std::vector<EncodedClip> clips;
  for (const TrainingClip& clip : model.training_clips) {
    if (!std::filesystem::exists(clip.path))
      throw InputError(fmt::format(
          "{}: a training clip of the model is gone; baselines are fitted on it, so put "
          "it back or leave them out",
          clip.path));
    clips.push_back(encode_clip(clip.path, model.modalities, model.modalities.camera,
                                options.keep_first_frame));
  }
  return clips;
}

void score_baselines(const Model& model, const TestRunOptions& options,
                     std::vector<ClipResult>& results) {
  std::vector<MatrixF> tracks, poses;
  for (EncodedClip& clip : encode_training_clips(model, options)) {
    tracks.push_back(std::move(clip.track_features));
    poses.push_back(std::move(clip.pose_features));
  }
  for (const auto& baseline : default_baselines()) {
    baseline->fit(tracks, poses);
    for (ClipResult& result : results) {
      const Motion motion = motion_from_features(
          model.modalities, baseline->predict(result.truth.track_features), result.truth.track,
          {result.truth.camera, result.truth.motion.skeleton});
      result.baseline_scores[baseline->name()] =
          score_clip(result.truth, motion, model.modalities.root_name());
    }
  }
}

}  // namespace

ClipScore score_clip(const EncodedClip& truth, const Motion& regenerated,
                     const std::string& root_name) {
  const int root = truth.motion.skeleton.find(root_name);
  const MatrixD real = judged_positions(truth.motion, root),
                other = judged_positions(regenerated, root);
  ClipScore score;
  // The root's own columns are zero on both sides: they would flatter the flattened figure.
  const auto joints = real.cols() - 3;
  score.pcc_flat = pearson_flat(real.rightCols(joints), other.rightCols(joints));
  score.pcc_channel = pearson_per_channel(real.rightCols(joints), other.rightCols(joints));
  score.error = joint_error(real, other, truth.motion.fps(), 0);
  const MatrixD path = joint_positions(regenerated).middleCols(3 * root, 3);
  const double mm = 1000.0 / file_units_per_metre(truth.motion.skeleton);
  score.root_mm = mm * (path - truth.root_position).rowwise().norm().mean();
  return score;
}

ClipScore mean_score(const std::vector<ClipScore>& scores) {
  ClipScore mean;
  const auto average = [&](auto&& member) {
    double sum = 0;
    for (const ClipScore& score : scores) sum += member(score);
    return sum / static_cast<double>(scores.size());
  };
  mean.pcc_flat = average([](const ClipScore& s) { return s.pcc_flat; });
  mean.pcc_channel = average([](const ClipScore& s) { return s.pcc_channel; });
  mean.root_mm = average([](const ClipScore& s) { return s.root_mm; });
  mean.error.mpjpe_mm = average([](const ClipScore& s) { return s.error.mpjpe_mm; });
  mean.error.pa_mpjpe_mm = average([](const ClipScore& s) { return s.error.pa_mpjpe_mm; });
  mean.error.mpjve_mm_s = average([](const ClipScore& s) { return s.error.mpjve_mm_s; });
  mean.error.acceleration_error_mm_s2 =
      average([](const ClipScore& s) { return s.error.acceleration_error_mm_s2; });
  mean.error.pck_150mm = average([](const ClipScore& s) { return s.error.pck_150mm; });
  mean.error.rmse_mm = average([](const ClipScore& s) { return s.error.rmse_mm; });
  return mean;
}

std::vector<ClipResult> run_test(const Model& model,
                                 const std::vector<std::filesystem::path>& files,
                                 const TestRunOptions& options) {
  std::vector<ClipResult> results;
  std::vector<MatrixF> tracks;
  for (const auto& file : files) {
    const bool trained_on = was_trained_on(model, file);
    if (trained_on && !options.include_training)
      throw InputError(
          fmt::format("{}: the model was trained on this clip; test on others, or say "
                      "--include-training",
                      file.string()));
    ClipResult result;
    result.truth = encode_clip(file, model.modalities, options.camera, options.keep_first_frame);
    result.trained_on = trained_on;
    tracks.push_back(result.truth.track_features);
    results.push_back(std::move(result));
  }
  const auto poses = regenerate(model.network, tracks, options.regeneration);
  const std::size_t samples = options.regeneration.samples;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ClipResult& result = results[i / samples];
    result.regenerated.push_back(
        motion_from_features(model.modalities, poses[i], result.truth.track,
                             {result.truth.camera, result.truth.motion.skeleton}));
    result.scores.push_back(
        score_clip(result.truth, result.regenerated.back(), model.modalities.root_name()));
  }
  if (options.baselines) score_baselines(model, options, results);
  return results;
}

}  // namespace mcdbn
