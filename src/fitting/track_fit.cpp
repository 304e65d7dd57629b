#include "mcdbn/fitting/track_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/track_rays.hpp"
#include "fitting/joint_fit.hpp"
#include "fitting/planted_velocity.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

/// How far the joints of other people are from where the model's skeleton has them. Measured on
/// held-out walkers on the model's skeleton: with 0.07 the fit takes their error from 42 to 38 and
/// from 34 to 33 mm, of which proportions are 28 and 26; trusted to 0.025 it makes the latter
/// larger.
constexpr double kProportions_m = 0.07;

/// What is wrong with the root's velocity where PosePrior::deviation is 1: the acceleration of the
/// error, on a 1.7 m body.
constexpr double kVelocityError_m_s2 = 1.0;

/// What is wrong with the root's velocity as planted feet tell it. Where the track is off by 5 px
/// the feet of held-out walkers slide 1.6 times as fast as in the capture without it, 1.2 times
/// with it, and on clean tracks 1.2 times either way; with less the root's position suffers.
constexpr double kPlantedError_m_s2 = 0.5;

constexpr double kSmallestDeviation = 1e-6;

/// The joints that the model looks at: others, such as a node that stays on the floor, may move in
/// the file unlike anything that a camera sees.
std::vector<std::string> tracked_joints(const TrackFeatures& features) {
  std::vector<std::string> names = features.joint_names();
  names.push_back(features.root_name());
  return names;
}

/// RMS of some standardized deviations. @param columns of the features before standardizing; those
/// that the standardizer dropped do not count. 1 if none is left.
double rms_deviation(const Eigen::Ref<const MatrixF>& deviation, const Standardizer& scale,
                     int first, int count) {
  double squares = 0, number = 0;
  for (std::size_t k = 0; k < scale.kept_columns().size(); ++k) {
    const int column = scale.kept_columns()[k];
    if (column < first || column >= first + count) continue;
    const auto of_feature = deviation.col(static_cast<Eigen::Index>(k)).cast<double>();
    squares += of_feature.squaredNorm();
    number += static_cast<double>(of_feature.size());
  }
  return number > 0 ? std::max(kSmallestDeviation, std::sqrt(squares / number)) : 1.0;
}

/// @return [frames x orientations]
MatrixD turn_deviations_rad(const MatrixF& deviation, const Modalities& features, double turn_deg) {
  const auto turns = static_cast<int>(features.pose_features.joints().size());
  const double turn_rad = turn_deg * std::numbers::pi / 180;
  MatrixD result(deviation.rows(), turns);
  for (Eigen::Index t = 0; t < result.rows(); ++t) {
    for (int turn = 0; turn < turns; ++turn) {
      result(t, turn) = turn_rad * rms_deviation(deviation.row(t), features.pose_scale,
                                                 PoseFeatures::kBlock * turn, PoseFeatures::kBlock);
    }
  }
  return result;
}

void check(const PosePrior& prior, const Modalities& features, const Track2d& track) {
  const auto frames = prior.mean.rows(), columns = prior.mean.cols();
  if (columns != features.pose_scale.output_dimension() || prior.deviation.rows() != frames ||
      prior.deviation.cols() != columns || frames != track.frames()) {
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

/// One clip on its way to its track.
class ClipFit {
 public:
  ClipFit(const PosePrior& prior, const Modalities& modalities, const Track2d& track,
          const KnownOfClip& known)
      : modalities_(modalities),
        skeleton_(known.skeleton ? *known.skeleton : modalities.pose_features.skeleton()),
        camera_(in_file_units(known.camera_of(track, modalities), skeleton_)),
        names_(tracked_joints(modalities.track_features)),
        track_(track_rays(names_, track, camera_)),
        features_(modalities.pose_in_camera(prior.mean, camera_.camera_from_world)) {
    velocity_ = file_units_per_metre(skeleton_) *
                modalities.pose_features.root_features(features_).rightCols(3) *
                camera_.camera_from_world;
    velocity_error_m_s2_ =
        kVelocityError_m_s2 * rms_deviation(prior.deviation, modalities.pose_scale,
                                            modalities.pose_features.velocity_feature(), 3);
  }

  void place_root() {
    root_ = root_trajectory(relative_positions(), track_, camera_, velocity_, velocity_error_m_s2_);
  }

  void turn_joints(const MatrixD& turn_deviation_rad, double track_noise_px,
                   const TrackFitSettings& settings) {
    features_ = fit_joints(modalities_.pose_features, features_, turn_deviation_rad, motion(),
                           track_, track_noise_px, camera_, settings);
    const MatrixD positions = relative_positions();
    root_ = root_trajectory(positions, track_, camera_, velocity_, velocity_error_m_s2_);
    const MatrixD planted = planted_velocity(motion(), skeleton_.find(modalities_.root_name()),
                                             foot_joints(skeleton_), velocity_);
    root_ = root_trajectory(positions, track_, camera_, planted, kPlantedError_m_s2);
  }

  Motion motion() const { return decoded(root_); }

  /// @param image whose size the result takes
  Track2d shown(const Track2d& image) const {
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
    root_.rowwise() += shift;
    camera_.translation -= camera_.camera_from_world * shift.transpose();
  }

  const Camera& camera() const { return camera_; }

 private:
  Motion decoded(const MatrixD& root) const {
    return modalities_.pose_features.decode(features_, camera_.camera_from_world, skeleton_,
                                            modalities_.fps, root);
  }

  /// Of the tracked joints about the root. @return [frames x 3·names]
  MatrixD relative_positions() const {
    const MatrixD all = joint_positions(decoded(MatrixD::Zero(features_.rows(), 3)));
    const MatrixD zero = all.middleCols(3 * skeleton_.find(modalities_.root_name()), 3);
    MatrixD positions(all.rows(), 3 * static_cast<Eigen::Index>(names_.size()));
    for (std::size_t i = 0; i < names_.size(); ++i)
      positions.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
          all.middleCols(3 * skeleton_.find(names_[i]), 3) - zero;
    return positions;
  }

  const Modalities& modalities_;
  Skeleton skeleton_;
  Camera camera_;
  std::vector<std::string> names_;
  TrackRays track_;
  MatrixD features_;  ///< not standardized, along the camera's own axes
  MatrixD velocity_;  ///< of the root, world axes, file units per second
  double velocity_error_m_s2_;
  MatrixD root_;  ///< its path where the camera sees it, [frames x 3]
};

}  // namespace

PosePrior PosePrior::around(MatrixF mean) {
  MatrixF deviation = MatrixF::Ones(mean.rows(), mean.cols());
  return {std::move(mean), std::move(deviation)};
}

FittedClip fit_to_track(const PosePrior& prior, const Modalities& features, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings) {
  check(prior, features, track);
  if (settings) check_settings(*settings);
  ClipFit clip(prior, features, track, known);
  clip.place_root();
  if (settings) {
    TrackFitSettings allowing = *settings;
    if (!known.skeleton) allowing.proportions_m = std::max(allowing.proportions_m, kProportions_m);
    clip.turn_joints(turn_deviations_rad(prior.deviation, features, allowing.turn_deg),
                     track_noise_px(track), allowing);
  }
  FittedClip result;
  result.shown = clip.shown(track);
  if (!known.camera) clip.put_at_origin();
  result.motion = clip.motion();
  result.camera = clip.camera();
  return result;
}

}  // namespace mcdbn
