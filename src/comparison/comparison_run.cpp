#include "comparison/comparison_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "comparison/fitted_baseline.hpp"
#include "corpus/clip_notices.hpp"
#include "corpus/people.hpp"
#include "evaluation/bone_length.hpp"
#include "evaluation/foot_slide.hpp"
#include "evaluation/orientation_error.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/side_swaps.hpp"
#include "mcdbn/evaluation/interval_share.hpp"
#include "mcdbn/evaluation/pearson.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/turned_motion.hpp"
#include "motion_model/pose_priors.hpp"

namespace mcdbn {
namespace {

bool was_trained_on(const Model& model, const std::filesystem::path& file) {
  return is_among(model.training_clips, identify_clip(file));
}

/// The person of a clip if a training clip shows the same one; else empty.
std::string known_person(const Model& model, const std::filesystem::path& file) {
  const std::string person = person_of(file);
  const bool known =
      std::any_of(model.training_clips.begin(), model.training_clips.end(),
                  [&](const TrainingClip& clip) { return person_of(clip.path) == person; });
  return known ? person : "";
}

/// An answer without the person's body stands on the model's skeleton, whose joints have their own
/// order and may be fewer.
void leave_out_missing(std::vector<std::string>& joints, const Skeleton& answered) {
  std::erase_if(joints, [&](const std::string& joint) { return answered.find(joint) < 0; });
}

/// Joints worth judging, the root first: none that stands where its parent stands in the truth.
std::vector<std::string> judged_joints(const Skeleton& truth, const Skeleton& answered,
                                       const std::string& root_name) {
  std::vector<std::string> names =
      TrackFeatures::for_skeleton(truth, truth.find(root_name)).joint_names();
  leave_out_missing(names, answered);
  names.insert(names.begin(), root_name);
  return names;
}

std::vector<std::string> judged_feet(const Skeleton& truth, const Skeleton& answered) {
  std::vector<std::string> names;
  for (const int foot : foot_joints(truth))
    names.push_back(truth.joints[static_cast<std::size_t>(foot)].name);
  leave_out_missing(names, answered);
  return names;
}

/// Of some joints. @param all [frames x 3·joints] of the skeleton  @return [frames x 3·joints]
MatrixD of_joints(const MatrixD& all, const Skeleton& skeleton,
                  const std::vector<std::string>& joints) {
  MatrixD some(all.rows(), 3 * std::ssize(joints));
  for (std::size_t i = 0; i < joints.size(); ++i)
    some.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
        all.middleCols(3 * skeleton.find(joints[i]), 3);
  return some;
}

/// Relative to the first joint, in mm. An answer may stand on another body, on which other joints
/// stand where their parents do: the truth's are judged.
/// @return [frames x 3·joints]
MatrixD judged_positions(const Motion& motion, const std::vector<std::string>& joints) {
  return of_joints(root_relative_positions_mm(motion, motion.skeleton.find(joints.front())),
                   motion.skeleton, joints);
}

/// @param positions [frames x 3·joints]  @return the same along other axes
MatrixD turned(MatrixD positions, const Eigen::Matrix3d& axes_from_world) {
  for (Eigen::Index joint = 0; joint < positions.cols(); joint += 3)
    positions.middleCols(joint, 3) = positions.middleCols(joint, 3) * axes_from_world.transpose();
  return positions;
}

/// A test clip as everyone sees it.
EncodedClip test_clip(const std::filesystem::path& file, const Model& model,
                      const TestRunOptions& options, std::uint64_t seed, ClipNotices& notices) {
  EncodedClip clip = encode_clip(file, model.modalities, options.camera, options.keep_first_frame,
                                 &notices, options.joint_map);
  if (options.detector) {
    AugmentedView view = detector_view(clip.motion, *options.detector, seed);
    exchange_sides(view.track, find_side_swaps(view.track));
    clip = encoded_view(file, model.modalities, std::move(view));
  }
  try {
    damage_track(clip.track, clip.motion.skeleton, options.damage, seed);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  if (!options.detector)
    clip.track_features = model.modalities.encode_track(smooth_track(clip.track), clip.camera);
  return clip;
}

/// Reading is the first tenth of a run, regenerating up to seven tenths, then baselines.
class Progress {
 public:
  explicit Progress(const TestRunOptions& options) : options_(options) {}
  void show(const std::string& what, double from, std::size_t done, std::size_t of) const {
    if (!options_.progress) return;
    const double to = from == kRegeneration ? kBaselines : from == kBaselines ? 1.0 : kRegeneration;
    options_.progress(what,
                      from + (to - from) * static_cast<double>(done) / static_cast<double>(of));
  }
  static constexpr double kRegeneration = 0.1, kBaselines = 0.7;

 private:
  const TestRunOptions& options_;
};

ClipPlacement placement_of(const EncodedClip& truth, const TestRunOptions& options) {
  ClipPlacement placement;
  if (options.camera_known) {
    placement.camera = truth.camera;
    // The answer may stand on a skeleton of other units.
    placement.camera->unit_m = 1.0 / file_units_per_metre(truth.motion.skeleton);
  }
  placement.detected = options.detector.has_value();
  if (!placement.detected) placement.skeleton = truth.motion.skeleton;
  placement.fit = options.fit;
  return placement;
}

/// What a method sees of the clip; what it does not it is left to fill in itself.
SeenClip seen_by(const Model& model, const TestRunOptions& options, const EncodedClip& truth,
                 const PoseAnswer& answer) {
  return see_clip(model.modalities, truth.track, placement_of(truth, options), answer);
}

/// @param draws from which `deviation_mm` is computed
Regeneration answer(const Model& model, const TestRunOptions& options, const EncodedClip& truth,
                    const SeenClip& seen, const PosePrior& prior,
                    const PosteriorDraws& draws = {}) {
  ClipPlacement placement = placement_of(truth, options);
  placement.found = seen.view;
  FittedClip fitted =
      fit_to_track(prior, model.modalities, seen.joints, placement, options.fit, draws);
  // Where the camera is not known the answer is in the axes of another one with the same view.
  const auto in_truths_axes = [&](Motion& motion) {
    if (placement.camera) return;
    motion = turned_motion(std::move(motion), truth.camera.camera_from_world.transpose() *
                                                  fitted.camera.camera_from_world);
  };
  in_truths_axes(fitted.motion);
  for (Motion& draw : fitted.draws) in_truths_axes(draw);
  Regeneration result;
  result.motion = std::move(fitted.motion);
  const std::string& root = model.modalities.root_name();
  result.score = score_clip(truth, result.motion, root);
  if (!fitted.draws.empty()) {
    const Skeleton& skeleton = result.motion.skeleton;
    result.deviation_mm = 1000 / file_units_per_metre(skeleton) *
                          joint_uncertainty(result.motion, fitted.draws, skeleton.find(root));
    result.score.within_90 = share_within_90(truth, result, root);
  }
  return result;
}

/// What of the truth the intervals of the single answer hold, and those of its prior.
void count_coverage(const Model& model, const TestRunOptions& options, const Regeneration& single,
                    const PosePrior& prior, ClipResult& clip) {
  if (single.deviation_mm.size() == 0) return;
  const Modalities& modalities = model.modalities;
  const std::vector<std::string> joints =
      judged_joints(clip.truth.motion.skeleton, single.motion.skeleton, modalities.root_name());
  const auto columns = 3 * (std::ssize(joints) - 1);  // the root is where it is
  clip.joints.add(
      {joints.begin() + 1, joints.end()},
      judged_positions(clip.truth.motion, joints).rightCols(columns),
      judged_positions(single.motion, joints).rightCols(columns),
      of_joints(single.deviation_mm, single.motion.skeleton, joints).rightCols(columns));
  if (!prior.has_deviation() || !options.camera_known) return;
  const std::vector<std::string> names = modalities.pose_features.feature_names();
  std::vector<std::string> kept;
  for (const int column : modalities.pose_scale.kept_columns())
    kept.push_back(names[static_cast<std::size_t>(column)]);
  clip.channels.add(kept, clip.truth.pose_features.cast<double>(), prior.mean.cast<double>(),
                    prior.deviation.cast<double>());
}

/// Of the single answer.
PosteriorDraws draws_of_clip(const TestRunOptions& options, std::size_t clip) {
  PosteriorDraws draws = options.uncertainty_draws;
  draws.seed += clip;
  return draws;
}

/// Clips go to the device some at a time, so that memory does not grow with the test.
constexpr std::size_t kSequencesAtOnce = 64;

void regenerate_clips(const Model& model, const TestRunOptions& options, const Progress& progress,
                      std::vector<ClipResult>& results) {
  const std::size_t samples = options.regeneration.samples;
  const std::size_t at_once = std::max<std::size_t>(1, kSequencesAtOnce / samples);
  for (std::size_t first = 0; first < results.size(); first += at_once) {
    progress.show("regenerating", Progress::kRegeneration, first, results.size());
    const std::size_t last = std::min(results.size(), first + at_once);
    std::vector<MatrixF> tracks;
    for (std::size_t i = first; i < last; ++i) {
      results[i].seen = seen_by(model, options, results[i].truth, [&](const MatrixF& track) {
        return pose_prior(model.network, track);
      });
      tracks.push_back(results[i].seen.features);
    }
    RegenerationOptions regeneration = options.regeneration;
    regeneration.seed += first;  // other random numbers for other clips
    const auto poses = pose_priors(model.network, tracks, regeneration);
    const bool drawn = regeneration.temperature > 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::size_t clip = first + i / samples;
      const bool single = !drawn && i % samples == 0;
      results[clip].samples.push_back(
          answer(model, options, results[clip].truth, results[clip].seen, poses[i],
                 single ? draws_of_clip(options, clip) : PosteriorDraws{}));
      if (single)
        count_coverage(model, options, results[clip].samples.back(), poses[i], results[clip]);
    }
    if (!drawn) continue;
    regeneration.temperature = 0;
    regeneration.samples = 1;
    const auto single = pose_priors(model.network, tracks, regeneration);
    for (std::size_t i = 0; i < single.size(); ++i) {
      ClipResult& result = results[first + i];
      result.others[kMeanField] = answer(model, options, result.truth, result.seen, single[i],
                                         draws_of_clip(options, first + i));
      count_coverage(model, options, result.others[kMeanField], single[i], result);
    }
  }
}

/// The other direction, from the true motion: what is done to tracks has no part in it.
void regenerate_tracks(const Model& model, std::vector<ClipResult>& results) {
  const Modalities& modalities = model.modalities;
  const std::size_t modality_count = model.network.modality_count();
  for (std::size_t first = 0; first < results.size(); first += kSequencesAtOnce) {
    const std::size_t last = std::min(results.size(), first + kSequencesAtOnce);
    std::vector<std::vector<MatrixF>> present(modality_count);
    for (std::size_t i = first; i < last; ++i)
      present[kPose].push_back(results[i].truth.pose_features);
    const auto tracks = regenerate(model.network, present, kTrack);
    for (std::size_t i = first; i < last; ++i) {
      const EncodedClip& clip = results[i].truth;
      const Track2d truth = project_motion(clip.motion, clip.camera);
      const auto error_px = [&](const MatrixF& standardized) {
        return track_error_px(truth, modalities.decode_track(standardized, clip.camera),
                              modalities.root_name());
      };
      const MatrixF& track = tracks[i - first];
      results[i].track = {error_px(track), error_px(MatrixF::Zero(track.rows(), track.cols()))};
    }
  }
}

void run_baselines(const Model& model, const TestRunOptions& options, const Progress& progress,
                   std::vector<ClipResult>& results) {
  BaselineTrainingData data =
      clip_training_data(model, options.keep_first_frame, options.joint_map);
  data.view_tracks = options.view_tracks;
  data.view_poses = options.view_poses;
  for (std::size_t i = 0; i < options.baselines.size(); ++i) {
    const std::string& name = options.baselines[i];
    progress.show("baseline " + name, Progress::kBaselines, i, options.baselines.size());
    const auto baseline = fitted_baseline(name, model, data);
    for (ClipResult& result : results) {
      const auto predict = [&](const MatrixF& track) { return baseline->predict(track); };
      const SeenClip seen = seen_by(model, options, result.truth, predict);
      result.others[name] = answer(model, options, result.truth, seen, predict(seen.features));
    }
  }
}

}  // namespace

double share_within_90(const EncodedClip& truth, const Regeneration& answer,
                       const std::string& root_name) {
  const Skeleton& skeleton = answer.motion.skeleton;
  const std::vector<std::string> judged = judged_joints(truth.motion.skeleton, skeleton, root_name);
  const auto joints = 3 * (std::ssize(judged) - 1);  // the root is where it is, on both sides
  return share_within_90(judged_positions(truth.motion, judged).rightCols(joints),
                         judged_positions(answer.motion, judged).rightCols(joints),
                         of_joints(answer.deviation_mm, skeleton, judged).rightCols(joints));
}

ClipScore score_clip(const EncodedClip& truth, const Motion& regenerated,
                     const std::string& root_name) {
  const Skeleton &own = truth.motion.skeleton, &answered = regenerated.skeleton;
  const std::vector<std::string> judged = judged_joints(own, answered, root_name);
  const MatrixD real = judged_positions(truth.motion, judged),
                other = judged_positions(regenerated, judged);
  ClipScore score;
  // The root's own columns are zero on both sides: they would flatter the flattened figure.
  const auto joints = real.cols() - 3;
  score.pcc_flat = pearson_flat(real.rightCols(joints), other.rightCols(joints));
  // Along the camera's axes (docs/concepts.md, PCC): along the world's own a walk straight ahead
  // has channels in which next to nothing moves.
  const Eigen::Matrix3d& axes = truth.camera.camera_from_world;
  score.pcc_channel = pearson_per_channel(turned(real.rightCols(joints), axes),
                                          turned(other.rightCols(joints), axes));
  score.error = joint_error(real, other, truth.motion.fps(), 0);
  score.limbs = limb_error(limb_positions_mm(truth.motion), limb_positions_mm(regenerated));
  score.mpjae_deg = mpjae_deg(truth.motion, regenerated);
  const auto mm = [](const Motion& motion) {
    return 1000.0 / file_units_per_metre(motion.skeleton);
  };
  const MatrixD path = joint_positions(regenerated).middleCols(3 * answered.find(root_name), 3);
  score.root_mm =
      (mm(regenerated) * path - mm(truth.motion) * truth.root_position).rowwise().norm().mean();
  const MatrixD world = world_positions_mm(regenerated);
  const std::vector<std::string> feet = judged_feet(own, answered);
  std::vector<int> columns(feet.size());
  std::iota(columns.begin(), columns.end(), 0);
  score.foot_slide = foot_slide(of_joints(world_positions_mm(truth.motion), own, feet),
                                of_joints(world, answered, feet), columns, truth.motion.fps());
  score.bone_length_spread_mm = bone_length_spread_mm(world, answered, answered.find(root_name));
  return score;
}

std::vector<ClipResult> run_test(const Model& model,
                                 const std::vector<std::filesystem::path>& files,
                                 const TestRunOptions& options) {
  if (!options.baselines.empty())
    require_training_clips(model, "take no baselines (`baselines` none)");
  const Progress progress(options);
  std::vector<ClipResult> results;
  ClipNotices found;
  for (const auto& file : files) {
    progress.show("reading clips", 0.0, results.size(), files.size());
    const bool trained_on = was_trained_on(model, file);
    if (trained_on && !options.include_training)
      throw InputError(
          fmt::format("{}: the model was trained on this clip; test on others, or set "
                      "`include-training`",
                      file.string()));
    ClipResult result;
    result.truth =
        test_clip(file, model, options, options.regeneration.seed + results.size(), found);
    result.trained_on = trained_on;
    result.known_person = known_person(model, file);
    results.push_back(std::move(result));
  }
  if (options.notices)
    for (const std::string& notice : found.all()) options.notices(notice);
  regenerate_clips(model, options, progress, results);
  regenerate_tracks(model, results);
  if (!options.baselines.empty()) run_baselines(model, options, progress, results);
  return results;
}

}  // namespace mcdbn
