#include "mcdbn/fitting/track_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/numbers.hpp"
#include "camera/track_rays.hpp"
#include "fitting/camera_angles.hpp"
#include "fitting/clip_evidence.hpp"
#include "fitting/posterior_draws.hpp"
#include "fitting/prior_deviations.hpp"
#include "fitting/prior_draws.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/rotation.hpp"
#include "fitting/seen_noise.hpp"
#include "fitting/sides_in_depth.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/tracked_joints.hpp"
#include "fitting/upright.hpp"
#include "fitting/usual_body.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// The error of the root's velocity where the prior has no deviation and no fit follows.
constexpr double kVelocityError_m_s2 = 1.0;

/// Those that the posterior's width is computed with.
TrackFitSettings settings_of_draws(TrackFitSettings settings) {
  settings.noise_lasts_s = settings.draws_noise_lasts_s;
  return settings;
}

void check(const PosePrior& prior, const Modalities& features, const Track2d& track) {
  const auto frames = prior.mean.rows(), columns = prior.mean.cols();
  const bool same = prior.deviation.rows() == frames && prior.deviation.cols() == columns;
  if (columns != features.pose_scale.output_dimension() || frames != track.frames() ||
      (prior.has_deviation() && !same)) {
    throw ShapeError(fmt::format(
        "fit_to_track: a mean of {}x{} and a deviation of {}x{}, expected {} columns, and as many "
        "rows as the track has frames ({})",
        frames, columns, prior.deviation.rows(), prior.deviation.cols(),
        features.pose_scale.output_dimension(), track.frames()));
  }
  if (!prior.deviation.allFinite() || (prior.deviation.array() < 0).any()) {
    throw InputError("a prior's deviation is negative or not finite; give 0 or more");
  }
}

/// The fit of one clip to its track.
class ClipFit {
 public:
  /// @param body that it begins with
  ClipFit(const PosePrior& prior, const Modalities& modalities, const Track2d& track,
          const KnownOfClip& known, Skeleton body)
      : modalities_(modalities),
        skeleton_(std::move(body)),
        assumed_(in_file_units(known.camera_of(track, modalities), skeleton_)),
        camera_(assumed_),
        units_per_m_(file_units_per_metre(skeleton_)),
        names_(tracked_joints(modalities.track_features)),
        track_(track_rays(names_, track, camera_)),
        features_(modalities.pose_in_camera(prior.mean, camera_.camera_from_world)) {
    velocity_ = file_units_per_metre(skeleton_) *
                modalities.pose_features.root_features(features_).rightCols(3) *
                camera_.camera_from_world;
    velocity_error_m_s2_ = prior.has_deviation() ? root_acceleration_deviation_m_s2(
                                                       prior, modalities, TrackFitSettings{})
                                                 : kVelocityError_m_s2;
  }

  void place_root() {
    put_root(root_trajectory(positions_about(modalities_.root_name(), names_,
                                             decoded(MatrixD::Zero(features_.rows(), 3))),
                             track_, camera_, velocity_, velocity_error_m_s2_, &placed_by_size_));
  }

  /// @param known as the constructor's; without a skeleton its proportions are unknown
  void meet_track(const PosePrior& prior, double track_noise_px, const KnownOfClip& known,
                  const Track2d& track, const TrackFitSettings& settings) {
    const bool may_be_exact = known.may_be_exact();
    mean_ = features_;
    evidence_.emplace(modalities_.pose_features, motion(), travelled(), track_, camera_);
    PosteriorClip& clip = evidence_->clip;
    clip.turn_deviation_rad = fitted_turn_deviations_rad(prior, modalities_, settings);
    clip.root_m_s2 = fitted_root_acceleration_deviation_m_s2(prior, modalities_, settings);
    clip.body_unknown = !known.skeleton;
    clip.camera = doubt_of(known, modalities_, track, settings);
    SeenNoise noise(track_noise_px, camera_, evidence_->usual_depth_m(), may_be_exact, settings);
    point_ = PosteriorPoint::zero(clip);
    look_again(settings);
    rays_ = noise.rays();
    rays_.steady = false;  // a rough solution is as far off as a detector's
    take(point_ = roughly_likely(clip, rays_, settings, std::move(point_)));
    // With a detector's track more frames a second carry no more information on what all frames
    // share, and a rough solution's window spans more seconds.
    const auto shared = may_be_exact ? SharedUnknowns::to_be_found : SharedUnknowns::as_found;
    const double small_gain = known.detected ? kSmallGainOfDetector : kSmallGainOfAll;
    for (std::size_t solution = 0; solution < settings.solutions; ++solution) {
      look_again(settings);
      rays_ = noise.rays();
      take(point_ = most_likely(clip, rays_, settings, std::move(point_), shared, small_gain));
      if (!noise.learn(evidence_->usual_residual(point_, clip.frames())) && !noise.measure()) break;
    }
    if (!rays_.exact) return;
    const double least = settings.exact_noise_px / std::sqrt(camera_.fx_px * camera_.fy_px);
    take(point_ = likeliest_of_exact(clip, rays_, settings, least, std::move(point_)));
  }

  /// After meet_track. The clip stays as it is.
  std::vector<Motion> drawn(const PosePrior& prior, TrackFitSettings settings,
                            const PosteriorDraws& draws, bool body_given) {
    settings = settings_of_draws(settings);
    const PosteriorPoint likeliest = point_;
    evidence_->clip.body_unknown = !body_given;
    evidence_->clip.turn_deviation_rad = fitted_turn_deviations_rad(prior, modalities_, settings);
    std::vector<Motion> motions;
    for (const PosteriorPoint& point :
         posterior_draws(evidence_->clip, rays_, settings, likeliest, draws.count, draws.seed)) {
      take(point);
      motions.push_back(motion());
    }
    take(likeliest);
    return motions;
  }

  /// Where no track is met. Before put_at_origin.
  void keep_open(const PosePrior& prior, bool body_given) {
    mean_ = features_;
    evidence_.emplace(modalities_.pose_features, motion(), travelled(), track_, camera_);
    evidence_->clip.turn_deviation_rad =
        turn_deviations_rad(prior, modalities_, settings_of_draws({}));
    evidence_->clip.body_unknown = !body_given;
  }
  /// After keep_open. The clip stays as it is, and the root of each draw where it is.
  std::vector<Motion> drawn_by_prior(const PosteriorDraws& draws) {
    const MatrixD features = features_, root = root_;
    const Skeleton skeleton = skeleton_;
    std::vector<Motion> motions;
    for (const PosteriorPoint& point :
         prior_draws(evidence_->clip, TrackFitSettings{}, draws.count, draws.seed)) {
      take(point);
      put_root(root);
      motions.push_back(motion());
    }
    features_ = features;
    skeleton_ = skeleton;
    put_root(root);
    return motions;
  }

  const Motion& motion() {
    if (!motion_) motion_ = decoded(root_);
    return *motion_;
  }

  /// @param image whose size the result takes
  Track2d shown(const Track2d& image) {
    Track2d result = project_motion(motion(), camera_);
    result.width_px = image.width_px;
    result.height_px = image.height_px;
    return result;
  }

  /// The camera moves along, so that it sees the same.
  void put_at_origin() {
    const double wanted = file_units_per_metre(skeleton_) *
                          modalities_.pose_features.root_features(features_).col(0).mean();
    const Eigen::RowVector3d shift(-root_(0, 0), wanted - root_.col(1).mean(), -root_(0, 2));
    put_root(root_.rowwise() + shift);
    shift_ += shift;
    camera_.translation -= camera_.camera_from_world * shift.transpose();
  }

  const Camera& camera() const { return camera_; }
  double energy() const { return point_.energy; }
  bool placed_by_size() const { return placed_by_size_; }
  /// How it looks, as it was found, where it was not known.
  AssumedView view() const {
    const Eigen::Vector3d up = camera_.camera_from_world.col(1);
    return {pitch_rad(up) / kRadiansPerDegree, roll_rad(up) / kRadiansPerDegree,
            2 * std::atan(camera_.height_px / (2 * camera_.fy_px)) / kRadiansPerDegree};
  }

 private:
  /// Finds standing feet, their ground and how the camera stands from the motion.
  void look_again(const TrackFitSettings& settings) {
    PosteriorClip& clip = evidence_->clip;
    evidence_->find_planted(motion());
    point_.ground_m = evidence_->ground(point_);
    if (clip.camera)
      clip.camera->balanced = evidence_->balanced(upright_in_camera(motion(), camera_), settings);
  }

  /// Pose, root and, if it is unknown, body are what the point makes of the prior's mean. A single
  /// camera does not determine the scale: body and distance are scaled so that the body is one of
  /// 1.7 m, as the camera's metres are meant, and it looks the same.
  void take(const PosteriorPoint& point) {
    features_ = evidence_->turned(mean_, point);
    double scale = 1;
    if (evidence_->clip.body_unknown) {
      skeleton_ = evidence_->body(point);
      scale = units_per_m_ / file_units_per_metre(skeleton_);
      for (Joint& joint : skeleton_.joints) joint.offset *= scale;
    }
    if (evidence_->clip.camera) look_as(point);
    put_root(evidence_->root(point, scale, seen_by()).rowwise() + shift_);
  }

  /// After what else changes of the motion: it is decoded anew.
  void put_root(MatrixD root) {
    root_ = std::move(root);
    motion_.reset();
  }

  void look_as(const PosteriorPoint& point) {
    camera_.camera_from_world = rotation_of(point.lean) * assumed_.camera_from_world;
    camera_.fx_px = std::exp(point.log_focal) * assumed_.fx_px;
    camera_.fy_px = std::exp(point.log_focal) * assumed_.fy_px;
  }

  /// The camera as it stood before put_at_origin.
  Camera seen_by() const {
    Camera camera = camera_;
    camera.translation += camera.camera_from_world * shift_.transpose();
    return camera;
  }

  /// [frames x 3] world axes, file units
  MatrixD travelled() const { return travelled_way(velocity_, track_.fps); }

  Motion decoded(const MatrixD& root) const {
    return modalities_.pose_features.decode(features_, camera_.camera_from_world, skeleton_,
                                            modalities_.fps, root);
  }

  const Modalities& modalities_;
  Skeleton skeleton_;
  Camera assumed_, camera_;  ///< at first, and as it was found
  double units_per_m_;
  std::vector<std::string> names_;
  TrackRays track_;
  MatrixD features_;  ///< not standardized, along the camera's own axes
  MatrixD velocity_;  ///< of the root, world axes, file units per second
  double velocity_error_m_s2_;
  bool placed_by_size_ = false;
  MatrixD root_;                       ///< its path where the camera sees it, [frames x 3]
  std::optional<Motion> motion_;       ///< of features, skeleton, camera and root as they are
  Eigen::RowVector3d shift_{0, 0, 0};  ///< that put it at the origin
  // Of meet_track:
  MatrixD mean_;  ///< the features that it began with
  std::optional<ClipEvidence> evidence_;
  RayNoise rays_;
  PosteriorPoint point_;
};

}  // namespace

FittedClip fit_to_track(const PosePrior& prior, const Modalities& features, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings,
                        const PosteriorDraws& draws) {
  check(prior, features, track);
  if (settings) check_settings(*settings);
  ClipFit clip(prior, features, track, known,
               settings ? body_to_begin_with(known, features)
                        : known.skeleton.value_or(features.pose_features.skeleton()));
  clip.place_root();
  const bool draws_any = draws.count > 0;
  if (settings)
    clip.meet_track(prior, track_noise_px(track), known, track, *settings);
  else if (draws_any)
    clip.keep_open(prior, known.body_given());
  FittedClip result;
  result.shown = clip.shown(track);
  if (!known.camera) clip.put_at_origin();
  if (draws_any)
    result.draws = settings ? clip.drawn(prior, *settings, draws, known.body_given())
                            : clip.drawn_by_prior(draws);
  result.motion = clip.motion();
  result.camera = clip.camera();
  result.energy = clip.energy();
  result.placed_by_size = clip.placed_by_size();
  if (!known.camera) result.view = settings ? clip.view() : known.assumed();
  return result;
}

}  // namespace mcdbn
