#include "camera/random_camera.hpp"

#include <Eigen/Geometry>

#include "base/numbers.hpp"
#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// Turned about its own axis; what was in the middle of the image stays there.
void roll(Camera& camera, double angle_deg) {
  const double angle = angle_deg * kRadiansPerDegree;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  camera.camera_from_world = turn * camera.camera_from_world;
  camera.translation = turn * camera.translation;
}

/// With room for what lies above and before the outermost joints: head, hands and feet.
bool all_in_view(const Camera& camera, const MatrixD& points) {
  constexpr double kMargin = 0.05;
  const double margin_x = kMargin * camera.width_px, margin_y = kMargin * camera.height_px;
  const MatrixD pixels = project_points(camera, points);
  const auto x = pixels(Eigen::all, Eigen::seqN(0, pixels.cols() / 2, 2)).array(),
             y = pixels(Eigen::all, Eigen::seqN(1, pixels.cols() / 2, 2)).array();
  return (x >= margin_x && x <= camera.width_px - margin_x && y >= margin_y &&
          y <= camera.height_px - margin_y)
      .all();
}

}  // namespace

Camera random_camera(const Motion& motion, const DetectorCameras& settings, std::uint64_t seed) {
  check_settings(settings);
  RandomSequence random(seed, random_streams::kRandomCamera);
  CameraPlacement placement;
  placement.azimuth_deg = random.uniform(-180, 180);
  placement.elevation_deg = random.uniform(settings.elevation_from_deg, settings.elevation_to_deg);
  placement.field_of_view_deg = random.uniform(settings.fov_from_deg, settings.fov_to_deg);
  const double distance_m = random.uniform(settings.distance_from_m, settings.distance_to_m);
  const double roll_deg = settings.roll_deg * random.normal();

  const MatrixD points = joint_positions(motion);
  const double unit = file_units_per_metre(motion.skeleton);
  placement.distance = distance_m * unit;
  constexpr double kStep = 1.1;
  for (;; *placement.distance *= kStep) {
    Camera camera = place_camera(points, placement);
    roll(camera, roll_deg);
    if (all_in_view(camera, points)) return camera;
  }
}

}  // namespace mcdbn
