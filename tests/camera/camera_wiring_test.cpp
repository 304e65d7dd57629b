// What a placed camera and a projected track are made of.

#include <doctest/doctest.h>

#include <cmath>

#include "mcdbn/camera/camera.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;

TEST_CASE("a placed camera has the turn, the lens and the image that were asked for") {
  const Motion motion = test::swinging(test::small_body(), 5);
  CameraPlacement placement;
  placement.azimuth_deg = 100;
  placement.elevation_deg = 20;
  placement.field_of_view_deg = 60;
  placement.width_px = 700;
  placement.height_px = 400;
  const Camera camera = place_camera(motion, placement);
  CHECK(camera.camera_from_world == camera_rotation(100, 20));
  CHECK(camera.fx_px == doctest::Approx(200 * std::sqrt(3.0)));  // half the height over tan 30°
  CHECK(camera.fy_px == camera.fx_px);
  CHECK(camera.cx_px == 350);
  CHECK(camera.cy_px == 200);
  CHECK(camera.width_px == 700);
  CHECK(camera.height_px == 400);
  CHECK(camera.distortion.empty());
  const Track2d track = project_motion(motion, camera);
  CHECK(track.width_px == 700);
  CHECK(track.height_px == 400);
  REQUIRE(track.joint_count() == motion.skeleton.joint_count());
  for (int j = 0; j < track.joint_count(); ++j)
    CHECK(track.joint_names[static_cast<std::size_t>(j)] == motion.skeleton.joints[j].name);
  const MatrixD pixels = project_points(camera, joint_positions(motion));
  CHECK(track.x_px.col(3) == pixels.col(6));
  CHECK(track.y_px.col(3) == pixels.col(7));
}

TEST_CASE("a placed camera fits what is wide into a tall image and what is tall into a wide one") {
  for (const bool wide_body : {true, false}) {
    for (const bool wide_image : {true, false}) {
      CAPTURE(wide_body);
      CAPTURE(wide_image);
      MatrixD points(1, 12);
      const double x = wide_body ? 100 : 5, y = wide_body ? 5 : 100;
      points << x, y, 0, -x, y, 0, x, -y, 0, -x, -y, 0;
      points.array() += 40;
      CameraPlacement placement;
      placement.azimuth_deg = 0;
      placement.elevation_deg = 0;
      placement.field_of_view_deg = 20;
      placement.width_px = wide_image ? 1000 : 300;
      placement.height_px = wide_image ? 300 : 1000;
      const MatrixD pixels = project_points(place_camera(points, placement), points);
      const double right = std::abs(pixels(0, 0) - placement.width_px / 2.0) / placement.width_px;
      const double up = std::abs(pixels(0, 1) - placement.height_px / 2.0) / placement.height_px;
      // The tighter side of the two takes 92 % of the half.
      CHECK(std::abs(std::max(right, up) - 0.46) < 1e-9);
    }
  }
}
