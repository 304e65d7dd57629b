#include "camera/random_camera.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct View {
  double azimuth_deg, elevation_deg, roll_deg, fov_deg, distance_m;
};

View view_of(const Camera& camera, const Motion& motion) {
  const MatrixD points = joint_positions(motion);
  Eigen::Vector3d low = points.row(0).head<3>(), high = low;
  for (Eigen::Index column = 0; column < points.cols(); ++column) {
    low[column % 3] = std::min(low[column % 3], points.col(column).minCoeff());
    high[column % 3] = std::max(high[column % 3], points.col(column).maxCoeff());
  }
  const Eigen::Vector3d forward = camera.camera_from_world.row(2),
                        right = camera.camera_from_world.row(0),
                        level = forward.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d eye = -camera.camera_from_world.transpose() * camera.translation;
  View view{};
  view.azimuth_deg = kDegrees * std::atan2(-forward.x(), -forward.z());
  view.elevation_deg = -kDegrees * std::asin(forward.y());
  view.roll_deg = kDegrees * std::atan2(right.dot(forward.cross(level)), right.dot(level));
  view.fov_deg = 2 * kDegrees * std::atan(camera.height_px / 2.0 / camera.fy_px);
  view.distance_m = ((low + high) / 2 - eye).norm() / file_units_per_metre(motion.skeleton);
  return view;
}

}  // namespace

TEST_CASE("random cameras stand all around the person, between the bounds") {
  const Motion motion = test::swinging(test::small_body(), 10);
  const DetectorCameras settings;
  std::vector<View> views;
  int quadrants[4] = {};
  constexpr int kCount = 300;
  double roll = 0;
  for (std::uint64_t seed = 0; seed < kCount; ++seed) {
    const Camera camera = random_camera(motion, settings, seed);
    const View view = view_of(camera, motion);
    ++quadrants[std::min(3, static_cast<int>((view.azimuth_deg + 180) / 90))];
    CHECK(view.elevation_deg >= -10 - 1e-9);
    CHECK(view.elevation_deg <= 35 + 1e-9);
    CHECK(view.fov_deg >= 35 - 1e-9);
    CHECK(view.fov_deg <= 70 + 1e-9);
    CHECK(view.distance_m >= 2.5 - 1e-9);
    CHECK(view.distance_m <= 8 + 1e-9);
    roll += view.roll_deg * view.roll_deg / kCount;
    const Track2d track = project_motion(motion, camera);
    CHECK((track.x_px.array() >= 0 && track.x_px.array() <= track.width_px).all());
    CHECK((track.y_px.array() >= 0 && track.y_px.array() <= track.height_px).all());
    views.push_back(view);
  }
  for (const int count : quadrants) CHECK(count > kCount / 6);
  CHECK(std::sqrt(roll) == doctest::Approx(8).epsilon(0.15));
  const auto spread = [&](double View::*of) {
    const auto [least, most] = std::ranges::minmax(views, {}, of);
    return most.*of - least.*of;
  };
  CHECK(spread(&View::elevation_deg) > 42);
  CHECK(spread(&View::fov_deg) > 33);
  CHECK(spread(&View::distance_m) > 5);
}

TEST_CASE("a random camera follows the seed and steps back where the clip does not fit") {
  Motion motion = test::swinging(test::small_body(), 10);
  CHECK(random_camera(motion, {}, 3).translation == random_camera(motion, {}, 3).translation);
  CHECK(random_camera(motion, {}, 3).translation != random_camera(motion, {}, 4).translation);
  for (int t = 0; t < motion.frames(); ++t) motion.channels(t, 0) = 500.0 * t;  // 45 m
  const Camera camera = random_camera(motion, {}, 3);
  CHECK(view_of(camera, motion).distance_m > 8);
  const Track2d track = project_motion(motion, camera);
  CHECK((track.x_px.array() >= 0 && track.x_px.array() <= track.width_px).all());
}

TEST_CASE("a random camera's settings are checked") {
  const Motion motion = test::swinging(test::small_body(), 10);
  DetectorCameras settings;
  settings.fov_to_deg = 180;
  CHECK_THROWS_AS(random_camera(motion, settings, 1), ConfigError);
  Motion empty = motion;
  empty.channels.resize(0, motion.channels.cols());
  CHECK_THROWS_AS(random_camera(empty, {}, 1), InputError);
}
