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
#include "fitting/seen_noise.hpp"
#include "fitting/sides_in_depth.hpp"
#include "fitting/stance.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/tracked_joints.hpp"
#include "fitting/usual_body.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// The error of the root's velocity where the prior has no deviation and no fit follows.
constexpr double kVelocityError_m_s2 = 1.0;

/// The settings for the posterior's width.
TrackFitSettings settings_of_draws(TrackFitSettings settings) {
  settings.detector_noise_time_s = settings.draws_noise_time_s;
  return settings;
}

void check(const PosePrior& prior, const Modalities& modalities, const Track2d& track) {
  const auto frames = prior.mean.rows(), columns = prior.mean.cols();
  const bool same = prior.deviation.rows() == frames && prior.deviation.cols() == columns;
  if (columns != modalities.pose_scale.output_dimension() || frames != track.frames() ||
      (prior.has_deviation() && !same)) {
    throw ShapeError(fmt::format(
        "fit_to_track: a mean of {}x{} and a deviation of {}x{}, expected {} columns, and as many "
        "rows as the track has frames ({})",
        frames, columns, prior.deviation.rows(), prior.deviation.cols(),
        modalities.pose_scale.output_dimension(), track.frames()));
  }
  if (!prior.deviation.allFinite() || (prior.deviation.array() < 0).any()) {
    throw InputError("a prior's deviation is negative or not finite; give 0 or more");
  }
}

/// Pose, body, camera and root of a clip.
struct FittedState {
  MatrixD features;  ///< not standardized, along the camera's own axes
  Skeleton skeleton;
  Camera camera;
  MatrixD root;  ///< its path where the camera sees it, [frames x 3] world, file units
};

/// The fit of one clip to its track.
class ClipFit {
 public:
  /// @param prior, modalities, track, known have to outlive this  @param body that it begins with
  ClipFit(const PosePrior& prior, const Modalities& modalities, const Track2d& track,
          const KnownOfClip& known, const Skeleton& body)
      : prior_(prior),
        modalities_(modalities),
        image_(track),
        known_(known),
        assumed_(in_file_units(known.camera_of(track, modalities), body)),
        names_(tracked_joints(modalities.track_features)),
        track_(track_rays(names_, track, assumed_)),
        mean_(modalities.pose_in_camera(prior.mean, assumed_.camera_from_world)),
        now_{mean_, body, assumed_, MatrixD::Zero(mean_.rows(), 3)} {
    velocity_ = file_units_per_metre(body) *
                modalities.pose_features.root_features(mean_).rightCols(3) *
                assumed_.camera_from_world;
    velocity_error_m_s2_ = prior.has_deviation() ? root_acceleration_deviation_m_s2(
                                                       prior, modalities, TrackFitSettings{})
                                                 : kVelocityError_m_s2;
  }

  void place_root() {
    const MatrixD about_root = positions_about(modalities_.root_name(), names_, decoded(now_));
    RootPath path = root_trajectory(about_root, track_, assumed_, velocity_, velocity_error_m_s2_);
    now_.root = std::move(path.root);
    placed_by_size_ = path.by_size;
  }

  /// After place_root. Without a known skeleton the body's proportions are found, too.
  void solve(const TrackFitSettings& settings) {
    const bool may_be_exact = known_.may_be_exact();
    evidence_.emplace(modalities_.pose_features, motion(), travelled(), track_, assumed_);
    evidence_->set_unknowns(prior_, modalities_, !known_.skeleton,
                            unknown_camera_of(known_, modalities_, image_, settings), settings);
    const PosteriorClip& clip = evidence_->clip;
    SeenNoise noise(track_noise_px(image_), assumed_, evidence_->usual_depth_m(), may_be_exact,
                    settings);
    point_ = PosteriorPoint::zero(clip);
    update_evidence(settings);
    rays_ = noise.rays();
    rays_.steady = false;  // a rough solution is as far off as a detector's
    take(coarse_solution(clip, rays_, settings, std::move(point_)));
    // With a detector's track more frames a second carry no more information on what all frames
    // share, and a rough solution's window spans more seconds.
    const auto shared = may_be_exact ? SharedUnknowns::to_be_found : SharedUnknowns::as_found;
    const double small_gain = known_.detected ? kSmallGainOfDetector : kSmallGainOfAll;
    for (std::size_t solution = 0; solution < settings.most_solutions; ++solution) {
      update_evidence(settings);
      rays_ = noise.rays();
      take(map_solution(clip, rays_, settings, std::move(point_), shared, small_gain));
      if (!noise.learn(evidence_->usual_residual(point_, clip.frames())) && !noise.measure()) break;
    }
    if (!rays_.exact) return;
    const double least = settings.least_noise_px / std::sqrt(now_.camera.fx_px * now_.camera.fy_px);
    take(likeliest_of_exact(clip, rays_, settings, least, std::move(point_)));
  }

  /// After solve.
  std::vector<Motion> drawn(TrackFitSettings settings, const PosteriorDraws& draws) const {
    settings = settings_of_draws(settings);
    PosteriorClip clip = evidence_->clip;
    clip.body_unknown = !known_.body_given();
    clip.turn_deviation_rad = fitted_turn_deviations_rad(prior_, modalities_, settings);
    std::vector<Motion> motions;
    for (const PosteriorPoint& point :
         posterior_draws(clip, rays_, settings, point_, draws.count, draws.seed))
      motions.push_back(decoded(state_at(point)));
    return motions;
  }

  /// In the place of solve. Before put_at_origin.
  void prepare_prior_draws() {
    evidence_.emplace(modalities_.pose_features, motion(), travelled(), track_, assumed_);
    evidence_->clip.turn_deviation_rad =
        turn_deviations_rad(prior_, modalities_, settings_of_draws({}));
    evidence_->clip.body_unknown = !known_.body_given();
  }
  /// After prepare_prior_draws. The root of each draw is where the clip's is.
  std::vector<Motion> drawn_by_prior(const PosteriorDraws& draws) const {
    std::vector<Motion> motions;
    for (const PosteriorPoint& point :
         prior_draws(evidence_->clip, TrackFitSettings{}, draws.count, draws.seed)) {
      FittedState draw = state_at(point);
      draw.root = now_.root;
      motions.push_back(decoded(draw));
    }
    return motions;
  }

  const Motion& motion() {
    if (!motion_) motion_ = decoded(now_);
    return *motion_;
  }

  Track2d shown() {
    Track2d result = project_motion(motion(), camera());
    result.width_px = image_.width_px;
    result.height_px = image_.height_px;
    return result;
  }

  /// Begins above the origin, the ground under ankles that stand; where none does, as high as the
  /// prior has the root. The camera moves along, so that it sees the same.
  void put_at_origin() {
    const double by_prior = file_units_per_metre(now_.skeleton) *
                            modalities_.pose_features.root_features(now_.features).col(0).mean();
    const std::optional<double> first = evidence_ ? evidence_->first_height(point_) : std::nullopt;
    const double rise = first ? *first - now_.root(0, 1) : by_prior - now_.root.col(1).mean();
    shift_ << -now_.root(0, 0), rise, -now_.root(0, 2);
    motion_.reset();
  }

  Camera camera() const {
    Camera camera = now_.camera;
    camera.translation -= camera.camera_from_world * shift_.transpose();
    return camera;
  }
  double energy() const { return point_.energy; }
  bool placed_by_size() const { return placed_by_size_; }
  /// How it looks, as it was found, where it was not known.
  AssumedView view() const {
    const Eigen::Vector3d up = now_.camera.camera_from_world.col(1);
    return {pitch_rad(up) / kRadiansPerDegree, roll_rad(up) / kRadiansPerDegree,
            2 * std::atan(now_.camera.height_px / (2 * now_.camera.fy_px)) / kRadiansPerDegree};
  }

 private:
  /// Finds standing feet, their ground and how the camera stands from the motion.
  void update_evidence(const TrackFitSettings& settings) {
    PosteriorClip& clip = evidence_->clip;
    evidence_->find_planted(motion());
    point_.ground_m = evidence_->ground(point_);
    if (clip.camera)
      clip.camera->balanced =
          evidence_->balanced(stance_in_camera(motion(), now_.camera), settings);
  }

  /// What a point makes of the prior's mean.
  FittedState state_at(const PosteriorPoint& point) const {
    const Camera camera = fitted_camera(point, assumed_);
    auto [body, scale] = evidence_->body(point);
    return {evidence_->turned(mean_, point), std::move(body), camera,
            evidence_->root(point, scale, camera)};
  }

  void take(PosteriorPoint point) {
    point_ = std::move(point);
    now_ = state_at(point_);
    motion_.reset();
  }

  /// [frames x 3] world axes, file units
  MatrixD travelled() const { return travelled_way(velocity_, track_.fps); }

  Motion decoded(const FittedState& state) const {
    return modalities_.pose_features.decode(state.features, state.camera.camera_from_world,
                                            state.skeleton, modalities_.fps,
                                            state.root.rowwise() + shift_);
  }

  const PosePrior& prior_;
  const Modalities& modalities_;
  const Track2d& image_;
  const KnownOfClip& known_;
  Camera assumed_;  ///< at first
  std::vector<std::string> names_;
  TrackRays track_;
  MatrixD mean_;  ///< the prior's, as FittedState::features
  FittedState now_;
  std::optional<Motion> motion_;       ///< of now_, once it was asked for
  Eigen::RowVector3d shift_{0, 0, 0};  ///< that puts the clip at the origin, and the camera along
  MatrixD velocity_;                   ///< of the root, world axes, file units per second
  double velocity_error_m_s2_;
  bool placed_by_size_ = false;
  // Results of solve():
  std::optional<ClipEvidence> evidence_;
  RayNoise rays_;
  PosteriorPoint point_;
};

}  // namespace

FittedClip fit_to_track(const PosePrior& prior, const Modalities& modalities, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings,
                        const PosteriorDraws& draws) {
  check(prior, modalities, track);
  if (settings) check_settings(*settings);
  ClipFit clip(prior, modalities, track, known,
               settings ? body_to_begin_with(known, modalities)
                        : known.skeleton.value_or(modalities.pose_features.skeleton()));
  clip.place_root();
  const bool draws_any = draws.count > 0;
  if (settings)
    clip.solve(*settings);
  else if (draws_any)
    clip.prepare_prior_draws();
  FittedClip result;
  result.shown = clip.shown();
  if (!known.camera) clip.put_at_origin();
  if (draws_any)
    result.draws = settings ? clip.drawn(*settings, draws) : clip.drawn_by_prior(draws);
  result.motion = clip.motion();
  result.camera = clip.camera();
  result.energy = clip.energy();
  result.placed_by_size = clip.placed_by_size();
  if (!known.camera) result.view = settings ? clip.view() : known.assumed();
  return result;
}

}  // namespace mcdbn
