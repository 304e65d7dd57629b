#include "mcdbn/camera/camera.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "camera/odd_camera.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

using namespace mcdbn;
using test::odd_camera;

namespace {

/// The least room in pixels between a joint and the image's border; negative outside.
double smallest_margin_px(const Track2d& track) {
  return std::min({track.x_px.minCoeff(), track.width_px - track.x_px.maxCoeff(),
                   track.y_px.minCoeff(), track.height_px - track.y_px.maxCoeff()});
}

}  // namespace

TEST_CASE("camera rotation: azimuth 0 looks along -z, +90 stands on +x, elevation looks down") {
  const Eigen::Matrix3d front = camera_rotation(0, 0);
  CHECK((front.row(2) - Eigen::RowVector3d(0, 0, -1)).norm() < 1e-12);
  CHECK((front.row(0) - Eigen::RowVector3d(1, 0, 0)).norm() < 1e-12);
  CHECK((front.row(1) - Eigen::RowVector3d(0, -1, 0)).norm() < 1e-12);
  CHECK((camera_rotation(90, 0).row(2) - Eigen::RowVector3d(-1, 0, 0)).norm() < 1e-12);
  CHECK(camera_rotation(0, 30)(2, 1) == doctest::Approx(-0.5));
  for (const double azimuth : {-170.0, 30.0, 250.0}) {
    for (const double elevation : {-90.0, 10.0, 90.0}) {
      const Eigen::Matrix3d rotation = camera_rotation(azimuth, elevation);
      CHECK((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
      CHECK(rotation.determinant() == doctest::Approx(1));
    }
  }
}

TEST_CASE("placements around: evenly, from the first on, all else as it is") {
  const CameraPlacement first{35, 12, 4.0, 50, 640, 480};
  CHECK(placements_around(first, 1) == std::vector<CameraPlacement>{first});
  const auto all = placements_around(first, 5);
  REQUIRE(all.size() == 5);
  for (std::size_t i = 0; i < all.size(); ++i) {
    CameraPlacement want = first;
    want.azimuth_deg = 35 + 72.0 * static_cast<double>(i);
    CHECK(all[i] == want);
  }
}

TEST_CASE("placed camera: the whole clip is in view, and not smaller than it needs to be") {
  const Motion motion = test::swinging(test::small_body(), 120);
  for (const double azimuth : {0.0, 30.0, 95.0, 200.0}) {
    for (const double field_of_view : {20.0, 45.0, 120.0}) {
      CameraPlacement placement;
      placement.azimuth_deg = azimuth;
      placement.field_of_view_deg = field_of_view;
      const Track2d track = project_motion(motion, place_camera(motion, placement));
      CHECK(track.confidence.minCoeff() == 1);
      CHECK(smallest_margin_px(track) > 20);
      // 4 % of the image's width is 76.8 pixels.
      if (field_of_view < 100) CHECK(smallest_margin_px(track) < 77);
    }
  }
}

TEST_CASE("placed camera: a given distance is kept, nonsense is refused") {
  const Motion motion = test::swinging(test::small_body(), 3);
  CameraPlacement placement;
  placement.distance = 777;
  const Camera camera = place_camera(motion, placement);
  const MatrixD positions = joint_positions(motion);
  Eigen::Vector3d low = positions.row(0).head<3>(), high = low;
  for (int column = 0; column < positions.cols(); ++column) {
    low[column % 3] = std::min(low[column % 3], positions.col(column).minCoeff());
    high[column % 3] = std::max(high[column % 3], positions.col(column).maxCoeff());
  }
  const Eigen::Vector3d centre = camera.camera_from_world * (low + high) / 2 + camera.translation;
  CHECK((centre - Eigen::Vector3d(0, 0, 777)).norm() < 1e-9);

  placement.distance = 0;
  CHECK_THROWS_AS(place_camera(motion, placement), ConfigError);
  placement.distance.reset();
  placement.field_of_view_deg = 180;
  CHECK_THROWS_AS(place_camera(motion, placement), ConfigError);
  placement.field_of_view_deg = 45;
  placement.height_px = 0;
  CHECK_THROWS_AS(place_camera(motion, placement), ConfigError);
  Motion empty = motion;
  empty.channels.resize(0, Eigen::NoChange);
  CHECK_THROWS_AS(place_camera(empty, {}), InputError);
}

TEST_CASE("projection: pinhole with distortion, as written down by OpenCV") {
  const Camera camera = odd_camera();
  MatrixD points(2, 6);
  points << 1, 2, 3, -40, 55, 60, 7, -8, 9, 20, 30, -30;
  const MatrixD pixels = project_points(camera, points);
  REQUIRE(pixels.cols() == 4);
  const auto& [k1, k2, p1, p2, k3] =
      std::array{camera.distortion[0], camera.distortion[1], camera.distortion[2],
                 camera.distortion[3], camera.distortion[4]};
  for (int frame = 0; frame < 2; ++frame) {
    for (int joint = 0; joint < 2; ++joint) {
      const Eigen::Vector3d world = points.row(frame).segment<3>(3 * joint);
      const Eigen::Vector3d seen = camera.camera_from_world * world + camera.translation;
      const double x = seen.x() / seen.z(), y = seen.y() / seen.z(), r2 = x * x + y * y;
      const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
      const double u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
      const double v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
      CHECK(pixels(frame, 2 * joint) == doctest::Approx(camera.fx_px * u + camera.cx_px));
      CHECK(pixels(frame, 2 * joint + 1) == doctest::Approx(camera.fy_px * v + camera.cy_px));
    }
  }
  CHECK(project_points(camera, MatrixD(0, 6)).rows() == 0);
  CHECK_THROWS_AS(project_points(camera, MatrixD(1, 5)), ShapeError);
}

TEST_CASE("projection: a joint behind the camera is missing, the others are not") {
  Camera camera;  // at the origin, looks along +z
  Motion motion{test::small_body(), 0.02, MatrixD::Zero(1, test::small_body().channel_count())};
  motion.channels(0, 2) = -0.5;  // Chest's offset of z = +1 brings the upper body before the camera
  const Track2d track = project_motion(motion, camera);
  const int hips = track.find("Hips"), chest = track.find("Chest");
  CHECK(std::isnan(track.x_px(0, hips)));
  CHECK(std::isnan(track.y_px(0, hips)));
  CHECK(track.confidence(0, hips) == 0);
  CHECK(std::isfinite(track.x_px(0, chest)));
  CHECK(track.confidence(0, chest) == 1);
  CHECK(track.fps == doctest::Approx(50));
  CHECK(track.find("nobody") == -1);
}

TEST_CASE("a camera of scaled images sees the same, smaller") {
  const Camera camera = odd_camera();
  std::vector<std::string> notices;
  const Camera half = of_scaled_images(camera, camera.width_px / 2, camera.height_px / 2, &notices);
  CHECK(notices.size() == 1);
  CHECK(half.width_px == camera.width_px / 2);
  MatrixD points(1, 6);
  points << 1, 2, 3, -40, 55, 60;
  const double x = static_cast<double>(half.width_px) / camera.width_px,
               y = static_cast<double>(half.height_px) / camera.height_px;
  const MatrixD wanted = project_points(camera, points), pixels = project_points(half, points);
  for (int joint = 0; joint < 2; ++joint) {
    CHECK(pixels(0, 2 * joint) == doctest::Approx(x * wanted(0, 2 * joint)));
    CHECK(pixels(0, 2 * joint + 1) == doctest::Approx(y * wanted(0, 2 * joint + 1)));
  }
  of_scaled_images(camera, camera.width_px, camera.height_px, &notices);
  CHECK(notices.size() == 1);
  CHECK_THROWS_WITH_AS(
      of_scaled_images(camera, 720, 1280),
      "its images are 720 x 1280 px, those of the camera 1280 x 720 px, which is another shape",
      InputError);
}

TEST_CASE("a camera whose size is a guess takes that of the images, but not scaled ones") {
  Camera camera;
  camera.cx_px = 981;
  camera.cy_px = 532;
  camera.width_px = 1962;
  camera.height_px = 1064;
  camera.size_is_guess = true;
  std::vector<std::string> notices;
  const Camera own = of_scaled_images(camera, 1920, 1080, &notices);
  CHECK(own.width_px == 1920);
  CHECK(own.height_px == 1080);
  CHECK(own.cx_px == 981);
  CHECK(own.fx_px == camera.fx_px);
  CHECK(notices.empty());
  CHECK_THROWS_AS(of_scaled_images(camera, 960, 540), InputError);
  CHECK_THROWS_AS(of_scaled_images(camera, 3840, 2160), InputError);
}

TEST_CASE("a camera's units: those of its motion, given in metres, are those of another motion") {
  const Skeleton skeleton = test::small_body();
  Skeleton large = skeleton;
  for (Joint& joint : large.joints) joint.offset *= 5.64;
  Camera camera;
  camera.translation << 1, 2, 3;
  const Camera written = with_unit(camera, skeleton);
  REQUIRE(written.unit_m.has_value());
  CHECK(in_file_units(written, skeleton).translation.isApprox(camera.translation, 1e-12));
  CHECK(in_file_units(written, large).translation.isApprox(5.64 * camera.translation, 1e-9));
  camera.unit_m = 0.5;
  CHECK(with_unit(camera, skeleton).unit_m == 0.5);
}

TEST_CASE("placed camera: real clips fit into the image") {
  for (const char* relative :
       {"cmu/walk/02_01.bvh", "bandai/wave_both_hands/dataset-2_wave-both-hands_normal_001.bvh",
        "bvh_zoo/walk01.bvh"}) {
    if (!test::have_shared_data(relative, "cameras on real clips")) continue;
    CAPTURE(relative);
    const Motion motion = read_bvh(test::shared_data() / relative);
    const Track2d track = project_motion(motion, place_camera(motion, {}));
    CHECK(track.confidence.minCoeff() == 1);
    CHECK(smallest_margin_px(track) > 20);
    CHECK(smallest_margin_px(track) < 77);
  }
}
