#include "mcdbn/camera/level_view.hpp"

#include <Eigen/Geometry>

#include "base/numbers.hpp"
#include "camera/track_rays.hpp"

namespace mcdbn {
namespace {

/// @param rays [frames x 2·joints] x/z and y/z  @return [frames x 3·joints] along other axes, NaN
/// where those do not see them
MatrixD turned_rays(const TrackRays& rays, const Eigen::Matrix3d& turn) {
  MatrixD turned(rays.frames(), 3 * rays.joints());
  for (Eigen::Index frame = 0; frame < rays.frames(); ++frame) {
    for (Eigen::Index joint = 0; joint < rays.joints(); ++joint) {
      const Eigen::Vector2d ray = rays.rays.row(frame).segment<2>(2 * joint);
      const Eigen::Vector3d direction = (turn * ray.homogeneous()).normalized();
      const bool seen = rays.seen(frame, joint) && direction.z() > kLevelViewLeastCosine;
      turned.row(frame).segment<3>(3 * joint) =
          seen ? direction : Eigen::Vector3d::Constant(kNan).eval();
    }
  }
  return turned;
}

}  // namespace

Eigen::Matrix3d level_rotation(const Eigen::Matrix3d& camera_from_world) {
  constexpr double kHorizontal = 1e-6;
  const Eigen::Vector3d viewing = camera_from_world.row(2), image_up = -camera_from_world.row(1);
  Eigen::Vector3d ahead(viewing.x(), 0, viewing.z());
  if (ahead.norm() < kHorizontal)
    ahead = (viewing.y() < 0 ? 1.0 : -1.0) * Eigen::Vector3d(image_up.x(), 0, image_up.z());
  const Eigen::Vector3d down(0, -1, 0);
  Eigen::Matrix3d rotation;
  rotation.row(2) = ahead.normalized();
  rotation.row(1) = down;
  rotation.row(0) = down.cross(ahead.normalized());
  return rotation;
}

Camera level_camera(const Camera& camera, double field_of_view_deg) {
  CameraPlacement view;
  view.field_of_view_deg = field_of_view_deg;
  view.width_px = camera.width_px;
  view.height_px = camera.height_px;
  Camera level = camera_at_origin(view);
  level.camera_from_world = level_rotation(camera.camera_from_world);
  level.translation =
      level.camera_from_world * camera.camera_from_world.transpose() * camera.translation;
  level.unit_m = camera.unit_m;
  return level;
}

Track2d turn_track(const Track2d& track, const Camera& from, const Camera& to) {
  const TrackRays rays = track_rays(track.joint_names, track, from);
  Camera lens = to;  // in its own axes
  lens.camera_from_world.setIdentity();
  lens.translation.setZero();
  const MatrixD pixels = project_points(
      lens, turned_rays(rays, to.camera_from_world * from.camera_from_world.transpose()));
  Track2d turned = track;
  turned.x_px = pixels(Eigen::all, Eigen::seqN(0, rays.joints(), 2));
  turned.y_px = pixels(Eigen::all, Eigen::seqN(1, rays.joints(), 2));
  turned.confidence = turned.x_px.array().isNaN().select(0.0, track.confidence.array());
  turned.width_px = to.width_px;
  turned.height_px = to.height_px;
  return turned;
}

}  // namespace mcdbn
