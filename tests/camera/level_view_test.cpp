#include "mcdbn/camera/level_view.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <numbers>

#include "camera/odd_camera.hpp"
#include "mcdbn/base/errors.hpp"

namespace level_view_test {

using namespace mcdbn;

namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// The odd camera, turned clockwise by so much as seen from behind it.
Camera rolled_camera(double roll_deg) {
  Camera camera = test::odd_camera();
  camera.camera_from_world =
      Eigen::AngleAxisd(-roll_deg * kRadians, Eigen::Vector3d::UnitZ()) * camera.camera_from_world;
  return camera;
}

/// Four points that the camera sees, at its own distance. [1 x 12] world
MatrixD points_before(const Camera& camera) {
  MatrixD points(1, 12);
  const Eigen::Vector3d seen[] = {{10, 20, 300}, {-60, -30, 250}, {-30, 90, 280}, {80, -40, 310}};
  for (int i = 0; i < 4; ++i)
    points.row(0).segment<3>(3 * i) =
        camera.camera_from_world.transpose() * (seen[i] - camera.translation);
  return points;
}

Track2d track_of(const MatrixD& points, const Camera& camera) {
  const MatrixD pixels = project_points(camera, points);
  Track2d track;
  track.joint_names = {"Head", "Hand", "Foot", "Tail"};
  track.x_px = pixels(Eigen::all, Eigen::seqN(0, 4, 2));
  track.y_px = pixels(Eigen::all, Eigen::seqN(1, 4, 2));
  track.confidence = MatrixD::Constant(1, 4, 0.25);
  track.fps = 47;
  track.width_px = camera.width_px;
  track.height_px = camera.height_px;
  return track;
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("level view: pitch and roll are taken out, the heading stays") {
  for (const double roll_deg : {0.0, 25.0, -90.0, 180.0})
    for (const double elevation_deg : {-40.0, 0.0, 10.0, 70.0}) {
      CAPTURE(roll_deg);
      CAPTURE(elevation_deg);
      const Eigen::Matrix3d roll =
          Eigen::AngleAxisd(roll_deg * kRadians, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const Eigen::Matrix3d level = level_rotation(roll * camera_rotation(-123.4, elevation_deg));
      CHECK(largest(level - camera_rotation(-123.4, 0)) < 1e-12);
    }
  CHECK((level_rotation(camera_rotation(20, 5)) * Eigen::Vector3d(0, -1, 0) -
         Eigen::Vector3d::UnitY())
            .norm() < 1e-12);
  // Straight down and straight up: ahead is towards the image's upper edge, or the lower one.
  for (const double elevation_deg : {90.0, -90.0})
    CHECK(largest(level_rotation(camera_rotation(33, elevation_deg)) - camera_rotation(33, 0)) <
          1e-9);
}

TEST_CASE("level view: a track is what a level pinhole at the same place would have seen") {
  const Camera camera = rolled_camera(24);
  const Camera level = level_camera(camera, 50);
  CHECK(level.distortion.empty());
  CHECK(level.fx_px == doctest::Approx(360 / std::tan(25 * kRadians)));
  CHECK(level.fy_px == level.fx_px);
  CHECK(level.cx_px == 640);
  CHECK(level.cy_px == 360);
  const Eigen::Vector3d place = -camera.camera_from_world.transpose() * camera.translation;
  CHECK((level.camera_from_world * place + level.translation).norm() < 1e-9);

  const MatrixD points = points_before(camera);
  const Track2d seen = track_of(points, camera), wanted = track_of(points, level);
  const Track2d turned = turn_track(seen, camera, level);
  CHECK(largest(turned.x_px - wanted.x_px) < 1e-5);
  CHECK(largest(turned.y_px - wanted.y_px) < 1e-5);
  CHECK(turned.confidence == seen.confidence);
  CHECK(turned.fps == 47);
  CHECK(turned.width_px == 1280);
  CHECK(turned.height_px == 720);
  // And back through the lens.
  const Track2d back = turn_track(turned, level, camera);
  CHECK(largest(back.x_px - seen.x_px) < 1e-5);
  CHECK(largest(back.y_px - seen.y_px) < 1e-5);
}

TEST_CASE("level view: what is not seen, or is beside or behind the level view, is missing") {
  Camera camera = rolled_camera(0);
  Track2d track = track_of(points_before(camera), camera);
  track.confidence(0, 1) = 0;
  track.x_px(0, 2) = std::numeric_limits<double>::quiet_NaN();
  const Track2d turned = turn_track(track, camera, level_camera(camera, 50));
  for (const int joint : {1, 2}) {
    CHECK(std::isnan(turned.x_px(0, joint)));
    CHECK(std::isnan(turned.y_px(0, joint)));
    CHECK(turned.confidence(0, joint) == 0);
  }
  CHECK(turned.confidence(0, 3) == 0.25);
  // From a camera that looks down by 80 degrees: the lower half of its image is behind the level
  // plane or next to it.
  CameraPlacement above;
  above.elevation_deg = 80;
  camera = camera_at_origin(above);
  Track2d column;
  column.joint_names = {"a", "b", "c", "d"};
  column.x_px = MatrixD::Constant(1, 4, camera.cx_px);
  column.y_px.resize(1, 4);
  int joint = 0;
  for (const double below_deg : {-20.0, 3.0, 5.0, 15.0})
    column.y_px(0, joint++) = camera.cy_px + camera.fy_px * std::tan(below_deg * kRadians);
  column.confidence = MatrixD::Ones(1, 4);
  const Track2d level = turn_track(column, camera, level_camera(camera, 45));
  CHECK(level.confidence == (MatrixD(1, 4) << 1, 1, 0, 0).finished());
}

TEST_CASE("level view: no view of that angle is a configuration error") {
  CHECK_THROWS_AS(level_camera({}, 180), ConfigError);
}

TEST_CASE("a camera in metres meets a body in file units, one without a unit is as it is") {
  Skeleton skeleton;
  skeleton.joints.push_back({});
  skeleton.joints[0].name = "Hips";
  Joint head;
  head.name = "Head";
  head.parent = 0;
  head.offset = {0, 17, 0};
  skeleton.joints.push_back(head);
  Camera camera = test::odd_camera();
  CHECK(in_file_units(camera, skeleton).translation == camera.translation);
  camera.unit_m = 1.0;
  const double per_metre = in_file_units(camera, skeleton).translation.z() / camera.translation.z();
  camera.unit_m = 0.001;
  const Camera converted = in_file_units(camera, skeleton);
  CHECK(converted.translation.z() == doctest::Approx(0.001 * per_metre * camera.translation.z()));
  CHECK_FALSE(converted.unit_m.has_value());
  // Twice the body in file units: twice as many of them make a metre.
  skeleton.joints[1].offset *= 2;
  CHECK(in_file_units(camera, skeleton).translation.z() ==
        doctest::Approx(2 * converted.translation.z()));
  CHECK(per_metre == doctest::Approx(10).epsilon(0.2));
}

}  // namespace level_view_test
