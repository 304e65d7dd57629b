#include "mcdbn/motion_model/clip_regeneration.hpp"

#include <algorithm>
#include <cmath>

#include "camera/track_resample.hpp"
#include "fitting/planted_velocity.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/track_smoothing.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"
#include "motion/resample.hpp"

namespace mcdbn {
namespace {

/// How far the joints of other people are from where the model's skeleton has them. Measured on
/// held-out walkers on the model's skeleton: with 0.07 the fit takes their error from 42 to 38 and
/// from 34 to 33 mm, of which proportions are 28 and 26; trusted to 0.025 it makes the latter
/// larger.
constexpr double kProportions_m = 0.07;

/// What is wrong with the root's velocity as planted feet tell it. Where the track is off by 5 px
/// the feet of held-out walkers slide 1.6 times as fast as in the capture without it, 1.2 times
/// with it, and on clean tracks 1.2 times either way; with less the root's place suffers.
constexpr double kPlantedError_m_s2 = 0.5;

/// More rounds change next to nothing: with an arm hidden for a second held-out walkers are off by
/// 8.9, 7.8, 7.6 and 7.5 mm after 0, 1, 2 and 4, all in sight by 6.5.
constexpr int kGapRounds = 3;

/// The joints that the model looks at: others, such as a node that stays on the floor, may move in
/// the file unlike anything that a camera sees.
std::vector<std::string> tracked_joints(const TrackFeatures& features) {
  std::vector<std::string> names = features.joint_names();
  names.push_back(features.root_name());
  return names;
}

/// @return [frames x 3·names], relative to joint `origin`
MatrixD positions_of(const Motion& motion, const std::vector<std::string>& names,
                     const std::string& origin) {
  const MatrixD all = joint_positions(motion);
  const MatrixD zero = all.middleCols(3 * motion.skeleton.find(origin), 3);
  MatrixD positions(all.rows(), 3 * static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i)
    positions.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
        all.middleCols(3 * motion.skeleton.find(names[i]), 3) - zero;
  return positions;
}

/// A camera of the model's view with the track's image size, at the world's origin.
Camera default_camera(const CameraPlacement& placement, const Track2d& track) {
  Camera camera;
  camera.camera_from_world = camera_rotation(placement.azimuth_deg, placement.elevation_deg);
  camera.width_px = track.width_px;
  camera.height_px = track.height_px;
  camera.fx_px = camera.fy_px =
      0.5 * track.height_px / std::tan(placement.field_of_view_deg * EIGEN_PI / 360.0);
  camera.cx_px = 0.5 * track.width_px;
  camera.cy_px = 0.5 * track.height_px;
  return camera;
}

/// Without a camera only the path's shape is known: it starts above the origin, at the height that
/// the features say.
void put_at_origin(MatrixD& root, double mean_height) {
  const double x = root(0, 0), z = root(0, 2), height = root.col(1).mean();
  root.col(0).array() -= x;
  root.col(1).array() += mean_height - height;
  root.col(2).array() -= z;
}

/// What was made of an answer before it is decoded.
struct Placed {
  MatrixD features;  ///< not standardized
  MatrixD root;      ///< its path, where the camera sees it: [frames x 3]
};

const Skeleton& skeleton_of(const Modalities& modalities, const ClipPlacement& placement) {
  return placement.skeleton ? *placement.skeleton : modalities.pose_features.skeleton();
}

Camera camera_of(const Modalities& modalities, const Track2d& track,
                 const ClipPlacement& placement) {
  return placement.camera ? *placement.camera : default_camera(modalities.camera, track);
}

Motion decoded(const Modalities& modalities, const Placed& placed, const Skeleton& skeleton,
               const Camera& camera) {
  return modalities.pose_features.decode(placed.features, camera.camera_from_world, skeleton,
                                         modalities.fps, placed.root);
}

/// The placement's fit, which allows for other proportions where the skeleton is not the person's.
std::optional<TrackFitSettings> fit_of(const ClipPlacement& placement) {
  std::optional<TrackFitSettings> fit = placement.fit;
  if (fit && !placement.skeleton) fit->proportions_m = std::max(fit->proportions_m, kProportions_m);
  return fit;
}

/// Puts an answer where the track shows it, and with a fit its joints too.
Placed place(const Modalities& modalities, const MatrixF& pose, const Track2d& track,
             const ClipPlacement& placement, const Camera& camera) {
  const Skeleton& skeleton = skeleton_of(modalities, placement);
  Placed placed{modalities.pose_scale.invert(pose), MatrixD()};
  const MatrixD root_features = modalities.pose_features.root_features(placed.features);
  const MatrixD velocity =
      file_units_per_metre(skeleton) * root_features.rightCols(3) * camera.camera_from_world;
  const std::vector<std::string> names = tracked_joints(modalities.track_features);
  const auto relative_positions = [&] {
    const Placed in_place{placed.features, MatrixD::Zero(placed.features.rows(), 3)};
    return positions_of(decoded(modalities, in_place, skeleton, camera), names,
                        modalities.root_name());
  };
  placed.root = root_trajectory(relative_positions(), names, track, camera, velocity);
  const std::optional<TrackFitSettings> fit = fit_of(placement);
  if (!fit) return placed;
  placed.features =
      fit_to_track(modalities.pose_features, placed.features,
                   decoded(modalities, placed, skeleton, camera), names, track, camera, *fit);
  const MatrixD positions = relative_positions();
  placed.root = root_trajectory(positions, names, track, camera, velocity);
  const MatrixD planted =
      planted_velocity(decoded(modalities, placed, skeleton, camera),
                       skeleton.find(modalities.root_name()), foot_joints(skeleton), velocity);
  placed.root = root_trajectory(positions, names, track, camera, planted, kPlantedError_m_s2);
  return placed;
}

Motion with_frames(Motion motion, Eigen::Index frames) {
  const Eigen::Index have = motion.channels.rows();
  MatrixD channels(frames, motion.channels.cols());
  for (Eigen::Index t = 0; t < frames; ++t)
    channels.row(t) = motion.channels.row(std::min(t, have - 1));
  motion.channels = std::move(channels);
  return motion;
}

}  // namespace

Motion motion_from_features(const Modalities& modalities, const MatrixF& pose, const Track2d& track,
                            const ClipPlacement& placement) {
  const Skeleton& skeleton = skeleton_of(modalities, placement);
  const Camera camera = camera_of(modalities, track, placement);
  Placed placed = place(modalities, pose, track, placement, camera);
  if (!placement.camera) {
    const double height = modalities.pose_features.root_features(placed.features).col(0).mean();
    put_at_origin(placed.root, file_units_per_metre(skeleton) * height);
  }
  return decoded(modalities, placed, skeleton, camera);
}

MatrixF fill_gaps(const Modalities& modalities, const MatrixF& features, const Track2d& track,
                  const ClipPlacement& placement,
                  const std::function<MatrixF(const MatrixF&)>& answer) {
  if (!features.array().isNaN().any()) return features;
  const Skeleton& skeleton = skeleton_of(modalities, placement);
  const Camera camera = camera_of(modalities, track, placement);
  MatrixF filled = features;
  for (int round = 0; round < kGapRounds; ++round) {
    const Placed placed = place(modalities, answer(filled), track, placement, camera);
    Track2d shown = project_motion(decoded(modalities, placed, skeleton, camera), camera);
    shown.width_px = track.width_px;
    shown.height_px = track.height_px;
    filled = features.array().isNaN().select(modalities.encode_track(shown), features);
  }
  return filled;
}

std::vector<Motion> regenerate_clip(const Model& model, const Track2d& track,
                                    const ClipPlacement& placement,
                                    const RegenerationOptions& options,
                                    TrackFeatures::FillCount* filled) {
  const Modalities& modalities = model.modalities;
  const Track2d at_rate = resample_track(track, modalities.fps);
  const MatrixF features =
      fill_gaps(modalities, modalities.encode_track(smooth_track(at_rate), filled), at_rate,
                placement, [&](const MatrixF& seen) { return single_answer(model.network, seen); });
  const auto poses = regenerate(model.network, {features}, options);
  std::vector<Motion> motions;
  for (const MatrixF& pose : poses) {
    const Motion motion = motion_from_features(modalities, pose, at_rate, placement);
    motions.push_back(with_frames(resample(motion, track.fps), track.frames()));
  }
  return motions;
}

}  // namespace mcdbn
