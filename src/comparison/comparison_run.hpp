// The room comparison: baselines, the run that scores the model beside them, and sweeps.
// It uses motion_model, evaluation.
// Add here: a baseline: a class behind Baseline, a line in baseline.cpp, its name and a sentence in
// evaluation/method_names.cpp, and its section in docs/baselines.md.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "camera/track_noise.hpp"
#include "comparison/answer_score.hpp"
#include "comparison/baseline.hpp"
#include "corpus/detector_view.hpp"
#include "corpus/encoded_clip.hpp"
#include "evaluation/coverage.hpp"
#include "evaluation/track_error.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// What a test run is made of. Every method is given the test clip's own skeleton and camera,
/// unless a detector saw it; its motion is not shown to anyone.
struct TestRunOptions {
  CameraPlacement camera;
  RegenerationOptions regeneration;
  /// What baselines that learn from views (the MLP) are fitted on where there are any, in place of
  /// the training clips: the views that the model's fine-tuning saw, [frames x dimension] each, so
  /// that both learnt from the same.
  std::vector<MatrixF> view_tracks, view_poses;
  std::optional<TrackFitSettings> fit =
      TrackFitSettings{};  ///< of every method's answer; unset: none
  /// Drawn of each clip, by seeds of its own: the uncertainty of the model's single answer.
  PosteriorDraws uncertainty_draws = {};
  TrackDamage damage;  ///< done to the test clips' tracks before any method sees them
  /// What a detector would see of the test clips in place of exact projections through `camera`.
  /// No method is given the body then, nor, unless `camera_known`, the camera.
  std::optional<DetectorViews> detector;
  bool camera_known = true;
  bool keep_first_frame = false;
  JointMap joint_map = {};        ///< roles of clips' joints, given by hand
  bool include_training = false;  ///< else a clip that was trained on is refused
  std::vector<std::string> baselines = usual_baselines();  ///< from baselines_of; may be none
  /// Called now and then with what is being done and how much of the run is done; may throw to
  /// stop.
  std::function<void(const std::string& what, double fraction)> progress;
  /// Called with what is odd about the test clips, line by line.
  std::function<void(const std::string& notice)> notices;
};

struct ClipResult {
  EncodedClip truth;
  SeenClip seen;  ///< what the model sees of its track
  bool trained_on = false;
  std::optional<std::string> known_person = "";  ///< as KnownPeople finds it
  std::vector<ScoredAnswer> samples;
  /// The baselines by name, and kMeanField, the model's single answer, if samples were drawn.
  std::map<std::string, ScoredAnswer> other_answers;
  TrackError track;  ///< 2D from the true 3D, by the model's mean field
  /// Coverage of the single answer's intervals, if uncertainty was drawn: of its judged joints, mm
  /// from the root along each axis; of the network's own channels, standardized, before any fit, if
  /// the camera is known and the network has deviations.
  Coverage joints, channels;
};

/// @throws InputError if a clip was trained on, or, before anything else, if a training clip that
///         the baselines need is gone
std::vector<ClipResult> run_test(const Model& model,
                                 const std::vector<std::filesystem::path>& files,
                                 const TestRunOptions& options);

}  // namespace mcdbn
