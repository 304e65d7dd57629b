#include "mcdbn/features/modalities.hpp"

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/numbers.hpp"
#include "mcdbn/camera/level_view.hpp"

namespace mcdbn {
namespace {

/// The camera whose pixels the 2D features are.
Camera feature_camera(const Modalities& modalities, const Camera& seen_by) {
  return level_camera(seen_by, modalities.camera.field_of_view_deg);
}

/// Joint-frames of the model's joints that a track shows, and not as it was turned.
int lost_by_turning(const Modalities& modalities, const Track2d& track, const Track2d& turned) {
  std::vector<std::string> names = modalities.track_features.joint_names();
  names.push_back(modalities.track_features.root_name());
  int lost = 0;
  for (const std::string& name : names) {
    const int column = track.find(name);
    if (column < 0) continue;
    const auto seen = track.confidence.col(column).array() > 0 &&
                      !track.x_px.col(column).array().isNaN() &&
                      !track.y_px.col(column).array().isNaN();
    lost += static_cast<int>((seen && !(turned.confidence.col(column).array() > 0)).count());
  }
  return lost;
}

}  // namespace

Eigen::Matrix3d Modalities::pose_axes(const Eigen::Matrix3d& camera_from_world) const {
  return level_view ? level_rotation(camera_from_world) : camera_from_world;
}

MatrixD Modalities::pose_values(const Motion& clip,
                                const Eigen::Matrix3d& camera_from_world) const {
  return pose_features.encode(clip, pose_axes(camera_from_world));
}

MatrixF Modalities::encode_pose(const Motion& clip,
                                const Eigen::Matrix3d& camera_from_world) const {
  return pose_scale.apply(pose_values(clip, camera_from_world));
}

MatrixD Modalities::pose_in_camera(const MatrixF& standardized,
                                   const Eigen::Matrix3d& camera_from_world) const {
  MatrixD values = pose_scale.invert(standardized);
  if (!level_view) return values;
  return pose_features.turned(values, camera_from_world * pose_axes(camera_from_world).transpose());
}

MatrixD Modalities::track_values(const Track2d& track, const Camera& seen_by,
                                 TrackFeatures::FillCount* filled) const {
  const RowVectorD usual =
      track_features.usual_squares(track_scale.mean(), track_scale.deviation());
  if (!level_view) return track_features.encode(track, filled, usual);
  const Track2d turned = turn_track(track, seen_by, feature_camera(*this, seen_by));
  if (filled) {
    track_features.encode(track, filled);  // what the track itself lacks
    filled->outside = lost_by_turning(*this, track, turned);
  }
  return track_features.encode(turned, nullptr, usual);
}

MatrixF Modalities::encode_track(const Track2d& track, const Camera& seen_by,
                                 TrackFeatures::FillCount* filled) const {
  return track_scale.apply(track_values(track, seen_by, filled));
}

Track2d Modalities::decode_track(const MatrixF& standardized, const Camera& seen_by) const {
  const Track2d track = track_features.decode(track_scale.invert(standardized), fps,
                                              seen_by.width_px, seen_by.height_px);
  return level_view ? turn_track(track, feature_camera(*this, seen_by), seen_by) : track;
}

Camera Modalities::assumed_camera(const AssumedView& view, int width_px, int height_px) const {
  CameraPlacement placement = camera;
  placement.width_px = width_px;
  placement.height_px = height_px;
  placement.elevation_deg = view.pitch_deg.value_or(level_view ? 0 : camera.elevation_deg);
  placement.field_of_view_deg = view.field_of_view_deg.value_or(
      level_view ? usual_field_of_view_deg(width_px, height_px) : camera.field_of_view_deg);
  const double roll_deg = view.roll_deg.value_or(0);
  check_range("a camera's pitch in degrees", AssumedView::kPitch_deg, placement.elevation_deg);
  check_range("a camera's roll in degrees", AssumedView::kRoll_deg, roll_deg);
  Camera assumed = camera_at_origin(placement);
  // A camera that is turned clockwise sees the world turned the other way.
  assumed.camera_from_world =
      Eigen::AngleAxisd(-roll_deg * kRadiansPerDegree, Eigen::Vector3d::UnitZ()) *
      assumed.camera_from_world;
  return assumed;
}

}  // namespace mcdbn
