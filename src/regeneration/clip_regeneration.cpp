#include "mcdbn/regeneration/clip_regeneration.hpp"

#include <cmath>

#include "mcdbn/motion/resample.hpp"
#include "mcdbn/motion/root_trajectory.hpp"
#include "mcdbn/motion/track_resample.hpp"

namespace mcdbn {
namespace {

std::vector<std::string> joint_names(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints) names.push_back(joint.name);
  return names;
}

MatrixD relative_to_joint(MatrixD positions, int joint) {
  const MatrixD origin = positions.middleCols(3 * joint, 3);
  for (Eigen::Index j = 0; j < positions.cols() / 3; ++j) positions.middleCols(3 * j, 3) -= origin;
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
  const MatrixD features = modalities.pose_scale.invert(pose);
  const Skeleton& skeleton =
      placement.skeleton ? *placement.skeleton : modalities.pose_features.skeleton();
  const Camera camera =
      placement.camera ? *placement.camera : default_camera(modalities.camera, track);
  const auto decode = [&](const MatrixD& root) {
    return modalities.pose_features.decode(features, camera.camera_from_world, skeleton,
                                           modalities.fps, root);
  };
  const int root_joint = skeleton.find(modalities.root_name());
  const Motion in_place = decode(MatrixD::Zero(features.rows(), 3));
  const double units = file_units_per_metre(skeleton);
  const MatrixD root_features = modalities.pose_features.root_features(features);
  const MatrixD velocity = units * root_features.rightCols(3) * camera.camera_from_world;
  MatrixD root = root_trajectory(relative_to_joint(joint_positions(in_place), root_joint),
                                 joint_names(skeleton), track, camera, velocity);
  if (!placement.camera) put_at_origin(root, units * root_features.col(0).mean());
  return decode(root);
}

std::vector<Motion> regenerate_clip(const Model& model, const Track2d& track,
                                    const ClipPlacement& placement,
                                    const RegenerationOptions& options,
                                    TrackFeatures::FillCount* filled) {
  const Modalities& modalities = model.modalities;
  const Track2d at_rate = resample_track(track, modalities.fps);
  const auto poses = regenerate(model.network, {modalities.encode_track(at_rate, filled)}, options);
  std::vector<Motion> motions;
  for (const MatrixF& pose : poses) {
    const Motion motion = motion_from_features(modalities, pose, at_rate, placement);
    motions.push_back(with_frames(resample(motion, track.fps), track.frames()));
  }
  return motions;
}

}  // namespace mcdbn
