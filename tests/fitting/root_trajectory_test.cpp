#include "fitting/root_trajectory.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/body_size.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

namespace root_trajectory_test {

using namespace mcdbn;

namespace {

/// A clip, its 2D track, and what root_trajectory is given and should answer. Units: centimetres.
struct Scene {
  Motion motion;
  Camera camera;
  Track2d track;
  std::vector<std::string> names;
  MatrixD relative, root, velocity;
};

Scene make_scene(const Motion& motion, const CameraPlacement& placement = {}) {
  Scene scene;
  scene.motion = motion;
  scene.camera = place_camera(scene.motion, placement);
  scene.camera.distortion = {-0.1, 0.02, 1e-3, -5e-4};
  scene.track = project_motion(scene.motion, scene.camera);
  scene.names = scene.track.joint_names;
  const MatrixD positions = joint_positions(scene.motion);
  scene.root = positions.leftCols<3>();
  scene.relative = positions - scene.root.replicate(1, scene.names.size());
  scene.velocity = MatrixD::Zero(motion.frames(), 3);
  const int steps = motion.frames() - 1;
  scene.velocity.bottomRows(steps) =
      (scene.root.bottomRows(steps) - scene.root.topRows(steps)) * motion.fps();
  scene.velocity.row(0) = scene.velocity.row(1);
  return scene;
}

/// A walk of four seconds: 1.2 m/s along z with a pelvis that bobs and sways.
Motion walk() {
  Motion motion = test::swinging(test::small_body(), 120);
  for (int frame = 0; frame < 120; ++frame) {
    const double phase = 2 * M_PI * frame / 30.0;
    motion.channels.row(frame).head<4>() << 3 * std::sin(phase), 92 + 2 * std::sin(2 * phase),
        4.0 * frame, 0;
    motion.channels(frame, 4) = 5 * std::sin(phase);
  }
  return motion;
}

MatrixD solve(const Scene& scene, bool with_velocity) {
  return root_trajectory(scene.relative, track_rays(scene.names, scene.track, scene.camera),
                         scene.camera, with_velocity ? scene.velocity : MatrixD(0, 3))
      .root;
}

void add_noise(Track2d& track, double deviation_px, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, deviation_px);
  for (MatrixD* pixels : {&track.x_px, &track.y_px}) {
    for (double& value : pixels->reshaped()) value += noise(random);
  }
}

/// The camera's view direction part of each row.
Eigen::VectorXd along_view(const Scene& scene, const MatrixD& vectors) {
  return vectors * scene.camera.camera_from_world.row(2).transpose();
}

double largest(const MatrixD& values) {
  return values.cwiseAbs().maxCoeff();
}

double rms(const MatrixD& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

MatrixD acceleration(const MatrixD& path, double fps) {
  const Eigen::Index n = path.rows() - 2;
  return (path.bottomRows(n) - 2 * path.middleRows(1, n) + path.topRows(n)) * fps * fps;
}

}  // namespace

TEST_CASE("root trajectory: a clean track gives the walk back within millimetres") {
  const Scene scene = make_scene(walk());
  CHECK(largest(solve(scene, true) - scene.root) < 0.05);
  CHECK(largest(solve(scene, false) - scene.root) < 0.5);
}

TEST_CASE("root trajectory: with 2 px of noise depth is smooth and unbiased") {
  const Scene clean = make_scene(walk());
  for (const bool with_velocity : {true, false}) {
    CAPTURE(with_velocity);
    double bias = 0;
    constexpr int kSeeds = 10;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      Scene scene = clean;
      add_noise(scene.track, 2, seed);
      const MatrixD error = solve(scene, with_velocity) - scene.root;
      bias += along_view(scene, error).mean() / kSeeds;
      CHECK(rms(error) < 1.5);
      // Half of the acceleration that the smoother takes for normal (1 and 4 m/s²); frame by
      // frame, noise of 3 cm in depth would make 70 m/s² of it.
      CHECK(rms(acceleration(error, 30)) < (with_velocity ? 50 : 200));
    }
    // Each clip's mean depth strays by 0.3: three deviations of their mean.
    CHECK(std::abs(bias) < 0.3);
  }
}

TEST_CASE("root trajectory: the model's velocity bridges what the track does not show") {
  Scene scene = make_scene(walk());
  scene.track.confidence.middleRows(40, 30).setZero();
  scene.track.x_px.middleRows(40, 30).setConstant(std::nan(""));
  const MatrixD path = solve(scene, true);
  CHECK(path.allFinite());
  CHECK(largest(path - scene.root) < 0.1);
  CHECK(largest(solve(scene, false) - scene.root) < 12);  // it bobs unseen for a second
  // Also at the ends, where the path follows from the velocity alone.
  scene = make_scene(walk());
  scene.track.confidence.topRows(10).setZero();
  scene.track.confidence.bottomRows(10).setZero();
  CHECK(largest(solve(scene, true) - scene.root) < 0.5);
}

TEST_CASE("root trajectory: a velocity that is off by a tenth bends nothing") {
  Scene scene = make_scene(walk());
  scene.velocity *= 1.1;
  CHECK(largest(solve(scene, true) - scene.root) < 0.5);
}

TEST_CASE("root trajectory: joints are joined by name, swapped ones do not pull") {
  Scene scene = make_scene(walk());
  const MatrixD whole = solve(scene, true);
  Scene mixed = scene;
  // Another order, and a joint that only one side has.
  std::reverse(mixed.track.joint_names.begin(), mixed.track.joint_names.end());
  mixed.track.x_px = scene.track.x_px.rowwise().reverse();
  mixed.track.y_px = scene.track.y_px.rowwise().reverse();
  CHECK(largest(solve(mixed, true) - whole) < 1e-6);
  mixed.track.joint_names[0] = "stranger";
  CHECK(largest(solve(mixed, true) - scene.root) < 0.1);
  // A hand that the tracker puts far away for two seconds.
  scene.track.x_px.block(30, scene.track.find("LHand"), 60, 1).array() += 300;
  CHECK(largest(solve(scene, true) - scene.root) < 2);
}

TEST_CASE("root trajectory: one or two frames, and nothing to see") {
  for (const int frames : {1, 2}) {
    Motion motion = walk();
    motion.channels.conservativeResize(frames, Eigen::NoChange);
    Scene scene = make_scene(walk());
    scene.track = project_motion(motion, scene.camera);
    const MatrixD path = root_trajectory(scene.relative.topRows(frames),
                                         track_rays(scene.names, scene.track, scene.camera),
                                         scene.camera, MatrixD(0, 3))
                             .root;
    CHECK(largest(path - scene.root.topRows(frames)) < 0.1);
  }
  Scene scene = make_scene(walk());
  CHECK_THROWS_AS(
      root_trajectory(scene.relative.topRows(9), track_rays(scene.names, scene.track, scene.camera),
                      scene.camera, scene.velocity),
      ShapeError);
  CHECK_THROWS_AS(
      root_trajectory(scene.relative, track_rays(scene.names, scene.track, scene.camera),
                      scene.camera, scene.velocity.topRows(9)),
      ShapeError);
  scene.track.confidence.setZero();
  CHECK_THROWS_AS(solve(scene, true), InputError);
  scene.track.joint_names.assign(scene.names.size(), "stranger");
  CHECK_THROWS_AS(solve(scene, true), InputError);
}

TEST_CASE("root trajectory: a real walk with 2 px of noise") {
  const char* relative = "cmu/walk/02_01.bvh";
  if (!test::have_shared_data(relative, "root trajectory of a real walk")) return;
  Motion motion = read_bvh(test::shared_data() / relative);
  const MatrixD all = motion.channels.bottomRows(motion.frames() - 1);
  motion.channels = all(Eigen::seqN(0, all.rows() / 4, 4), Eigen::all);
  motion.frame_time_s *= 4;
  Scene scene = make_scene(motion);
  const double millimetre = file_units_per_metre(motion.skeleton) / 1000;
  CHECK(largest(solve(scene, true) - scene.root) < 3 * millimetre);
  CHECK(largest(solve(scene, false) - scene.root) < 10 * millimetre);
  add_noise(scene.track, 2, 1);
  CHECK(rms(solve(scene, true) - scene.root) < 8 * millimetre);
  CHECK(rms(solve(scene, false) - scene.root) < 12 * millimetre);
}

}  // namespace root_trajectory_test
