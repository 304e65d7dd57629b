// OpenCV's fisheye lens: projected as OpenCV does, and back.
#include <doctest/doctest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "camera/odd_camera.hpp"
#include "camera/track_rays.hpp"
#include "mcdbn/camera/level_view.hpp"

namespace fisheye_test {

using namespace mcdbn;

namespace {

Camera fisheye() {
  Camera camera = test::odd_camera();
  camera.distortion = {-0.03, 0.011, -0.004, 0.002};
  camera.fisheye = true;
  return camera;
}

Camera in_own_axes(Camera camera) {
  camera.camera_from_world.setIdentity();
  camera.translation.setZero();
  return camera;
}

/// Directions 0 to 88 degrees aside, all around, as one frame of points.
MatrixD fan(const std::vector<double>& aside_deg) {
  MatrixD points(1, 3 * static_cast<Eigen::Index>(aside_deg.size()));
  for (std::size_t i = 0; i < aside_deg.size(); ++i) {
    const double aside = aside_deg[i] * CV_PI / 180, around = 0.7 * static_cast<double>(i);
    points.row(0).segment<3>(3 * static_cast<Eigen::Index>(i)) =
        (1 + 0.1 * static_cast<double>(i)) * Eigen::RowVector3d(std::sin(aside) * std::cos(around),
                                                                std::sin(aside) * std::sin(around),
                                                                std::cos(aside));
  }
  return points;
}

Track2d track_of(const MatrixD& pixels) {
  Track2d track;
  const Eigen::Index joints = pixels.cols() / 2;
  for (Eigen::Index joint = 0; joint < joints; ++joint)
    track.joint_names.push_back(std::to_string(joint));
  track.x_px = pixels(Eigen::all, Eigen::seqN(0, joints, 2));
  track.y_px = pixels(Eigen::all, Eigen::seqN(1, joints, 2));
  track.confidence =
      track.x_px.array().isNaN().select(MatrixD::Zero(1, joints), MatrixD::Ones(1, joints));
  return track;
}

}  // namespace

TEST_CASE("fisheye: what the lens does is OpenCV's, its formula written out") {
  const Camera camera = in_own_axes(fisheye());
  const MatrixD points = fan({0.5, 20, 45, 70, 83});
  const MatrixD pixels = project_points(camera, points);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::Vector3d point = points.row(0).segment<3>(3 * i);
    const double r = point.head<2>().norm(), theta = std::atan2(r, point.z());
    const double t2 = theta * theta;
    const auto& k = camera.distortion;
    const double bent = theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
    CHECK(pixels(0, 2 * i) ==
          doctest::Approx(camera.fx_px * bent / r * point.x() + camera.cx_px).epsilon(1e-9));
    CHECK(pixels(0, 2 * i + 1) ==
          doctest::Approx(camera.fy_px * bent / r * point.y() + camera.cy_px).epsilon(1e-9));
  }
}

TEST_CASE("fisheye: from anywhere as cv::fisheye::projectPoints has it") {
  const Camera camera = fisheye();
  MatrixD points(2, 6);
  points << 10, 20, 30, 0, 0, 25, -130, 90, 28, 60, -80, 14;
  const MatrixD pixels = project_points(camera, points);
  cv::Mat rotation;
  cv::Matx33d matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      matrix(row, column) = camera.camera_from_world(row, column);
  cv::Rodrigues(matrix, rotation);
  std::vector<cv::Point3d> world;
  for (int i = 0; i < 4; ++i)
    world.emplace_back(points.data()[3 * i], points.data()[3 * i + 1], points.data()[3 * i + 2]);
  std::vector<cv::Point2d> expected;
  cv::fisheye::projectPoints(
      world, expected, rotation,
      cv::Vec3d(camera.translation.x(), camera.translation.y(), camera.translation.z()),
      cv::Matx33d(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1),
      cv::Vec4d(camera.distortion.data()));
  for (int i = 0; i < 4; ++i) {
    CHECK(pixels.data()[2 * i] == doctest::Approx(expected[static_cast<std::size_t>(i)].x));
    CHECK(pixels.data()[2 * i + 1] == doctest::Approx(expected[static_cast<std::size_t>(i)].y));
  }
}

TEST_CASE("fisheye: pixels are the rays that made them, up to 84 degrees aside") {
  for (const std::vector<double>& distortion :
       {std::vector<double>{}, std::vector<double>{-0.03, 0.011, -0.004, 0.002}}) {
    Camera camera = in_own_axes(fisheye());
    camera.distortion = distortion;
    const MatrixD points = fan({0.5, 20, 45, 70, 83, 85, 120});
    Track2d track = track_of(project_points(camera, points));
    const TrackRays rays = track_rays(track.joint_names, track, camera);
    for (Eigen::Index i = 0; i < 7; ++i) {
      CAPTURE(i);
      CHECK(rays.seen(0, i) == (i < 5));
      if (i >= 5) continue;
      const Eigen::Vector3d point = points.row(0).segment<3>(3 * i);
      const Eigen::Vector2d ray = point.head<2>() / point.z();
      CHECK((rays.rays.row(0).segment<2>(2 * i).transpose() - ray).norm() <
            1e-6 * (1 + ray.squaredNorm()));
    }
    // A pixel outside of all that the lens shows is no ray.
    track.x_px(0, 0) = 1e5;
    CHECK_FALSE(track_rays(track.joint_names, track, camera).seen(0, 0));
  }
}

TEST_CASE("fisheye: a level pinhole sees what the fisheye saw") {
  const Camera from = fisheye();
  const Eigen::Vector3d centre = -from.camera_from_world.transpose() * from.translation;
  MatrixD points(1, 9);
  for (int i = 0; i < 3; ++i)
    points.row(0).segment<3>(3 * i) = (centre + 300 * from.camera_from_world.row(2).transpose() +
                                       Eigen::Vector3d(90 - 60 * i, 40 * i, 30 * i - 20))
                                          .transpose();
  const Camera level = level_camera(from, 45);
  const Track2d turned = turn_track(track_of(project_points(from, points)), from, level);
  const MatrixD expected = project_points(level, points);
  for (int i = 0; i < 3; ++i) {
    CHECK(turned.x_px(0, i) == doctest::Approx(expected(0, 2 * i)).epsilon(1e-7));
    CHECK(turned.y_px(0, i) == doctest::Approx(expected(0, 2 * i + 1)).epsilon(1e-7));
  }
}

}  // namespace fisheye_test
