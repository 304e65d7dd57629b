// A pinhole whose radial distortion turns back: what is further out would come into the image
// again.
#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/capture_bound.hpp"
#include "mcdbn/camera/camera.hpp"

namespace folded_lens_test {

using namespace mcdbn;

namespace {

/// In its own axes.
Camera pinhole(std::vector<double> distortion) {
  Camera camera;
  camera.distortion = std::move(distortion);
  return camera;
}

/// Whether points are seen that are so far aside, x/z and y/z, all around.
bool all_seen(const Camera& camera, double ray) {
  MatrixD points(1, 3 * 12);
  for (int i = 0; i < 12; ++i)
    points.row(0).segment<3>(3 * i) =
        (1 + i) * Eigen::RowVector3d(ray * std::cos(i * 0.5), ray * std::sin(i * 0.5), 1);
  const MatrixD pixels = project_points(camera, points);
  CHECK((pixels.array().isNaN().all() || !pixels.hasNaN()));
  return !pixels.hasNaN();
}

/// OpenCV's factor of a ray whose square is s, with k1 k2 p1 p2 k3 k4 k5 k6.
double factor(const std::vector<double>& k, double s) {
  return (1 + s * (k[0] + s * (k[1] + s * k[4]))) / (1 + s * (k[5] + s * (k[6] + s * k[7])));
}

}  // namespace

TEST_CASE("folded lens: rays are seen to where the distortion turns back, and no further") {
  struct Case {
    std::vector<double> distortion;
    double square;  ///< of the ray where its derivative is 0, or the denominator is
  };
  const double k1 = 0.196, k2 = -0.367;
  for (const auto& [distortion, square] : {
           Case{{k1, k2, 0, 0, 0, 0, 0, 0},
                (3 * k1 + std::sqrt(9 * k1 * k1 - 20 * k2)) / (-10 * k2)},  // 44 degrees
           Case{{-0.3, 0, 0, 0, 0, 0, 0, 0}, 1 / 0.9},
           Case{{0, 0, 0, 0, -0.1, 0, 0, 0}, std::cbrt(1 / 0.7)},
           Case{{0, 0, 0, 0, 0, 1, 0, 0}, 1},
           Case{{0, 0, 0, 0, 0, 0, 0.2, 0}, std::sqrt(1 / 0.6)},
           Case{{0, 0, 0, 0, 0, 0, 0, 0.3}, std::cbrt(1 / 1.5)},
           Case{{0, 0, 0, 0, 0, -0.5, 0, 0}, 2},
       }) {
    CAPTURE_BOUND(square);
    const double turn = std::sqrt(square);
    // It is the first place where the ray is longest.
    const auto bent = [&, &k = distortion](double ray) { return ray * factor(k, ray * ray); };
    for (int i = 1; i < 100; ++i) CHECK(bent(turn * i / 100) > bent(turn * (i - 1) / 100));
    const Camera camera = pinhole(distortion);
    for (const double part : {0.1, 0.5, 0.9, 1 - 1e-6}) CHECK(all_seen(camera, part * turn));
    for (const double part : {1 + 1e-6, 1.1, 2.0, 10.0, 1000.0})
      CHECK_FALSE(all_seen(camera, part * turn));
    MatrixD point(1, 3);
    point << 0.6 * turn, 0.7 * turn, 1;
    const double bend = factor(distortion, point.leftCols(2).squaredNorm());
    const MatrixD pixel = project_points(camera, point);
    CHECK(pixel(0, 0) == doctest::Approx(camera.fx_px * bend * point(0, 0) + camera.cx_px));
    CHECK(pixel(0, 1) == doctest::Approx(camera.fy_px * bend * point(0, 1) + camera.cy_px));
  }
}

TEST_CASE("folded lens: what never turns back sees all before it") {
  const double almost_aside = std::tan(89.9 * EIGEN_PI / 180);
  for (const std::vector<double>& distortion :
       {std::vector<double>{}, std::vector<double>{0, 0, 0, 0}, std::vector<double>{0.3, 0.1, 0, 0},
        std::vector<double>{-0.21, 0.07, 1e-3, -2e-3, 0.01},
        std::vector<double>{0.1, 0, 0, 0, 0, 0.1, 0, 0}}) {
    const Camera camera = pinhole(distortion);
    for (const double ray : {0.1, 1.0, 5.0, 50.0, almost_aside}) {
      CAPTURE(ray);
      CHECK(all_seen(camera, ray));
    }
    MatrixD behind(1, 3);
    behind << 0.1, 0, -1;
    CHECK(project_points(camera, behind).array().isNaN().all());
  }
  // Further aside than any step in which a distortion is looked at.
  CHECK(all_seen(pinhole({}), 1e6));
}

TEST_CASE("folded lens: a motion that walks out of its view is not seen there") {
  Camera camera = pinhole({0.196, -0.367, 0, 0});
  Motion motion;
  motion.skeleton.joints.push_back(
      {"Hips", -1, {0, 0, 0}, {Channel::x_position, Channel::y_position, Channel::z_position}, {}});
  motion.channels.resize(3, 3);
  motion.channels << 0.5, 0, 1, 0.9, 0, 1, 1.2, 0, 1;
  const Track2d track = project_motion(motion, camera);
  CHECK(track.confidence.col(0) == Eigen::Vector3d(1, 1, 0));
  CHECK(track.x_px(1, 0) > track.x_px(0, 0));
  CHECK(std::isnan(track.x_px(2, 0)));
}

}  // namespace folded_lens_test
