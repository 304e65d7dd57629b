#include "comparison/comparison_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/named_errors.hpp"
#include "base/numbers.hpp"
#include "comparison/fitted_baseline.hpp"
#include "comparison/known_people.hpp"
#include "corpus/clip_notices.hpp"
#include "evaluation/report_clip.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/side_swaps.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/body_size.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/turned_motion.hpp"
#include "motion_model/pose_priors.hpp"

namespace mcdbn {
namespace {

bool was_trained_on(const Model& model, const std::filesystem::path& file) {
  return is_among(model.training_clips, identify_clip(file));
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
  with_name(file.string(),
            [&] { damage_track(clip.track, clip.motion.skeleton, options.damage, seed); });
  if (!options.detector)
    clip.track_features = model.modalities.encode_track(smooth_track(clip.track), clip.camera);
  return clip;
}

/// How much of a run is done when a stage of it begins and ends.
struct Stage {
  double from, to;
};
constexpr Stage kReading{0, 0.1}, kRegenerating{0.1, 0.7}, kBaselines{0.7, 1};

class Progress {
 public:
  explicit Progress(const TestRunOptions& options) : options_(options) {}
  /// @param done of the parts of the stage
  void show(const std::string& what, const Stage& stage, std::size_t done, std::size_t of) const {
    if (!options_.progress) return;
    options_.progress(what, stage.from + (stage.to - stage.from) * static_cast<double>(done) /
                                             static_cast<double>(of));
  }

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
  return with_name(truth.file.string(), [&] {
    return see_clip(model.modalities, truth.track, placement_of(truth, options), answer);
  });
}

/// Where the camera is not known the answer is in the axes of another one with the same view.
void turn_into_axes_of(const Camera& camera, FittedClip& answer) {
  const Eigen::Matrix3d turn =
      camera.camera_from_world.transpose() * answer.camera.camera_from_world;
  answer.motion = turned_motion(std::move(answer.motion), turn);
  for (Motion& draw : answer.draws) draw = turned_motion(std::move(draw), turn);
}

/// @param draws from which `deviation_mm` is computed
ScoredAnswer answer(const Model& model, const TestRunOptions& options, const EncodedClip& truth,
                    const SeenClip& seen, const PosePrior& prior,
                    const PosteriorDraws& draws = {}) {
  ClipPlacement placement = placement_of(truth, options);
  placement.found = seen.view;
  FittedClip fitted = with_name(truth.file.string(), [&] {
    FittedClip found =
        fit_to_track(prior, model.modalities, seen.joints, placement, options.fit, draws);
    if (!placement.camera) turn_into_axes_of(truth.camera, found);
    return found;
  });
  ScoredAnswer result;
  result.motion = std::move(fitted.motion);
  const std::string& root = model.modalities.root_name();
  result.score = score_clip(truth, result.motion, root);
  // An answer without a camera begins at an origin of its own.
  if (!placement.camera) result.score.root_mm = kNan;
  if (!fitted.draws.empty()) {
    const Skeleton& skeleton = result.motion.skeleton;
    result.deviation_mm = 1000 / file_units_per_metre(skeleton) *
                          joint_uncertainty(result.motion, fitted.draws, skeleton.find(root));
    result.score.within_90 = share_within_90(truth, result, root);
  }
  return result;
}

/// What of the truth the intervals of the single answer hold, and those of its prior.
void count_coverage(const Model& model, const TestRunOptions& options, const ScoredAnswer& single,
                    const PosePrior& prior, ClipResult& clip) {
  if (single.deviation_mm.size() == 0) return;
  const Modalities& modalities = model.modalities;
  const JudgedPlaces judged =
      judged_places(clip.truth, single.motion, single.deviation_mm, modalities.root_name());
  clip.joints.add(judged.joints, judged.truth_mm, judged.answer_mm, judged.deviation_mm);
  if (!prior.has_deviation() || !options.camera_known) return;
  const std::vector<std::string> names = modalities.pose_features.feature_names();
  std::vector<std::string> kept;
  for (const int column : modalities.pose_scale.kept_columns())
    kept.push_back(names[static_cast<std::size_t>(column)]);
  clip.channels.add(kept, clip.truth.pose_features.cast<double>(), prior.mean.cast<double>(),
                    prior.deviation.cast<double>());
}

/// Draws for the single answer of a clip, with a seed of its own.
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
    progress.show("regenerating", kRegenerating, first, results.size());
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
      result.other_answers[kMeanField] = answer(model, options, result.truth, result.seen,
                                                single[i], draws_of_clip(options, first + i));
      count_coverage(model, options, result.other_answers[kMeanField], single[i], result);
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
    progress.show("baseline " + name, kBaselines, i, options.baselines.size());
    const auto baseline = fitted_baseline(name, model, data);
    for (ClipResult& result : results) {
      const auto predict = [&](const MatrixF& track) { return baseline->predict(track); };
      const SeenClip seen = seen_by(model, options, result.truth, predict);
      result.other_answers[name] =
          answer(model, options, result.truth, seen, predict(seen.features));
    }
  }
}

}  // namespace

std::vector<ClipResult> run_test(const Model& model,
                                 const std::vector<std::filesystem::path>& files,
                                 const TestRunOptions& options) {
  if (!options.baselines.empty())
    require_training_clips(model, "take no baselines (`baselines` none)");
  const Progress progress(options);
  std::vector<ClipResult> results;
  ClipNotices found;
  KnownPeople people(model.training_clips);
  for (const auto& file : files) {
    progress.show("reading clips", kReading, results.size(), files.size());
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
    result.known_person = people.find(file);
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
