#include "mcdbn/camera/camera.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/numbers.hpp"
#include "camera/lens.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {

namespace {

/// How much of the image's half width and height the body may fill.
constexpr double kFill = 0.92;

void check(const CameraPlacement& placement) {
  check_range("a camera's field of view in degrees", CameraPlacement::kFieldOfView_deg,
              placement.field_of_view_deg);
  if (placement.width_px <= 0 || placement.height_px <= 0) {
    throw ConfigError(fmt::format("image size {}x{}; give pixels above 0", placement.width_px,
                                  placement.height_px));
  }
  if (placement.distance && !(*placement.distance > 0)) {
    throw ConfigError(
        fmt::format("camera distance {}; give file units above 0", *placement.distance));
  }
}

/// The least distance from `centre` at which every point is in view and well before the camera.
/// @param points [frames x 3·joints] world
double fitting_distance(const Camera& camera, const MatrixD& points,
                        const Eigen::Vector3d& centre) {
  const double slope_x = camera.fx_px / (kFill * camera.width_px / 2.0);
  const double slope_y = camera.fy_px / (kFill * camera.height_px / 2.0);
  double distance = 0, radius = 0;
  for (Eigen::Index frame = 0; frame < points.rows(); ++frame) {
    for (Eigen::Index column = 0; column < points.cols(); column += 3) {
      const Eigen::Vector3d seen =
          camera.camera_from_world * (points.row(frame).segment<3>(column).transpose() - centre);
      distance = std::max({distance, std::abs(seen.x()) * slope_x - seen.z(),
                           std::abs(seen.y()) * slope_y - seen.z()});
      radius = std::max(radius, seen.norm());
    }
  }
  // A wide field of view would let the camera stand inside the body.
  distance = std::max(distance, 1.2 * radius);
  return distance > 0 ? distance : 1.0;
}

/// A camera whose size was guessed, as that of images of a known size.
Camera of_images(Camera camera, int width_px, int height_px) {
  constexpr double kAside = 0.2;  // of the image; calibrations are off by a few hundredths
  if (std::abs(camera.cx_px / width_px - 0.5) > kAside ||
      std::abs(camera.cy_px / height_px - 0.5) > kAside)
    throw InputError(fmt::format(
        "its images are {} x {} px, and the camera's principal point at {:.0f}, {:.0f} is far from "
        "their middle: it was calibrated with images of another size",
        width_px, height_px, camera.cx_px, camera.cy_px));
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.size_is_guess = false;
  return camera;
}

}  // namespace

Eigen::Matrix3d camera_rotation(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * kRadiansPerDegree,
               elevation = elevation_deg * kRadiansPerDegree;
  const Eigen::Vector3d to_camera(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                  std::cos(azimuth) * std::cos(elevation));
  const Eigen::Vector3d right(std::cos(azimuth), 0, -std::sin(azimuth));
  Eigen::Matrix3d rotation;
  rotation.row(0) = right;
  rotation.row(1) = right.cross(to_camera);
  rotation.row(2) = -to_camera;
  return rotation;
}

std::vector<CameraPlacement> placements_around(const CameraPlacement& first, std::size_t count) {
  std::vector<CameraPlacement> placements(count, first);
  for (std::size_t i = 0; i < count; ++i)
    placements[i].azimuth_deg += 360.0 * static_cast<double>(i) / static_cast<double>(count);
  return placements;
}

Camera place_camera(const Motion& motion, const CameraPlacement& placement) {
  return place_camera(joint_positions(motion), placement);
}

Camera in_file_units(Camera camera, const Skeleton& skeleton) {
  if (camera.unit_m) camera.translation *= *camera.unit_m * file_units_per_metre(skeleton);
  camera.unit_m.reset();
  return camera;
}

Camera with_unit(Camera camera, const Skeleton& skeleton) {
  if (!camera.unit_m) camera.unit_m = 1 / file_units_per_metre(skeleton);
  return camera;
}

Camera scaled(Camera camera, int width_px, int height_px) {
  const double x = static_cast<double>(width_px) / camera.width_px;
  const double y = static_cast<double>(height_px) / camera.height_px;
  camera.fx_px *= x;
  camera.cx_px *= x;
  camera.fy_px *= y;
  camera.cy_px *= y;
  camera.width_px = width_px;
  camera.height_px = height_px;
  return camera;
}

Camera of_scaled_images(Camera camera, int width_px, int height_px,
                        std::vector<std::string>* notices) {
  if (camera.size_is_guess) return of_images(std::move(camera), width_px, height_px);
  if (camera.width_px == width_px && camera.height_px == height_px) return camera;
  const std::string sizes = fmt::format("its images are {} x {} px, those of the camera {} x {} px",
                                        width_px, height_px, camera.width_px, camera.height_px);
  constexpr double kRounded = 0.01;  // of a side that was scaled to whole pixels
  const double wider = static_cast<double>(width_px) / camera.width_px /
                       (static_cast<double>(height_px) / camera.height_px);
  if (std::abs(wider - 1) > kRounded) throw InputError(sizes + ", which is another shape");
  if (notices != nullptr) notices->push_back(sizes + ": the camera is scaled to them");
  return scaled(std::move(camera), width_px, height_px);
}

Camera camera_at_origin(const CameraPlacement& placement) {
  check(placement);
  Camera camera;
  camera.camera_from_world = camera_rotation(placement.azimuth_deg, placement.elevation_deg);
  camera.width_px = placement.width_px;
  camera.height_px = placement.height_px;
  camera.cx_px = placement.width_px / 2.0;
  camera.cy_px = placement.height_px / 2.0;
  camera.fx_px = camera.fy_px =
      placement.height_px / 2.0 / std::tan(placement.field_of_view_deg * kRadiansPerDegree / 2);
  return camera;
}

Camera place_camera(const MatrixD& points, const CameraPlacement& placement) {
  Camera camera = camera_at_origin(placement);
  if (points.size() == 0) throw InputError("the clip has no frames; nothing to look at");
  Eigen::Vector3d low = points.row(0).head<3>(), high = low;
  for (Eigen::Index column = 0; column < points.cols(); ++column) {
    low[column % 3] = std::min(low[column % 3], points.col(column).minCoeff());
    high[column % 3] = std::max(high[column % 3], points.col(column).maxCoeff());
  }
  const Eigen::Vector3d centre = (low + high) / 2;
  const double distance = placement.distance.value_or(fitting_distance(camera, points, centre));
  camera.translation = Eigen::Vector3d(0, 0, distance) - camera.camera_from_world * centre;
  return camera;
}

MatrixD project_points(const Camera& camera, const MatrixD& points) {
  if (points.cols() % 3 != 0) {
    throw ShapeError(fmt::format("project_points: {} columns, not three a joint", points.cols()));
  }
  const Eigen::Index joints = points.cols() / 3;
  MatrixD pixels(points.rows(), 2 * joints);
  if (pixels.size() == 0) return pixels;
  // Row-major frames of x y z lie in memory as OpenCV wants its list of points; it only reads them.
  const cv::Mat world(static_cast<int>(points.rows() * joints), 1, CV_64FC3,
                      const_cast<double*>(points.data()));
  cv::Mat image(world.rows, 1, CV_64FC2, pixels.data());
  project_through_lens(camera, world, image);
  const double steepest = steepest_ray(camera);
  for (Eigen::Index frame = 0; frame < points.rows(); ++frame) {
    for (Eigen::Index joint = 0; joint < joints; ++joint) {
      const Eigen::Vector3d point = points.row(frame).segment<3>(3 * joint);
      if (!is_before_lens(camera.camera_from_world * point + camera.translation, steepest))
        pixels.row(frame).segment<2>(2 * joint).setConstant(kNan);
    }
  }
  return pixels;
}

Track2d project_motion(const Motion& motion, const Camera& camera) {
  const MatrixD pixels = project_points(camera, joint_positions(motion));
  Track2d track;
  for (const Joint& joint : motion.skeleton.joints) track.joint_names.push_back(joint.name);
  const auto joints = static_cast<Eigen::Index>(track.joint_names.size());
  track.x_px = pixels(Eigen::all, Eigen::seqN(0, joints, 2));
  track.y_px = pixels(Eigen::all, Eigen::seqN(1, joints, 2));
  track.confidence = track.x_px.array().isNaN().select(MatrixD::Zero(motion.frames(), joints),
                                                       MatrixD::Ones(motion.frames(), joints));
  track.fps = motion.fps();
  track.width_px = camera.width_px;
  track.height_px = camera.height_px;
  return track;
}

}  // namespace mcdbn
