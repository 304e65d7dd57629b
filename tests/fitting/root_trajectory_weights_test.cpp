// What root_trajectory weighs: confidences, the velocity's error, and units that must not matter.

#include <doctest/doctest.h>

#include "camera/track_noise.hpp"
#include "fitting/root_trajectory.hpp"
#include "motion/synthetic_motion.hpp"

namespace root_trajectory_weights_test {

using namespace mcdbn;

namespace {

struct Scene {
  Camera camera;
  Track2d track;
  MatrixD relative, root, velocity;

  MatrixD solve(double velocity_error_m_s2 = 1) const {
    return root_trajectory(relative, track_rays(track.joint_names, track, camera), camera, velocity,
                           velocity_error_m_s2)
        .root;
  }
};

/// @param scale file units in a centimetre
Scene make_scene(double scale = 1, double fps = 30) {
  Motion motion = test::swinging(test::small_body(), 60, fps);
  motion.channels.leftCols<3>() *= scale;
  for (Joint& joint : motion.skeleton.joints) joint.offset *= scale;
  Scene scene;
  scene.camera = place_camera(motion, {});
  scene.track = project_motion(motion, scene.camera);
  const MatrixD positions = joint_positions(motion);
  scene.root = positions.leftCols<3>();
  scene.relative = positions - scene.root.replicate(1, scene.track.joint_count());
  scene.velocity = MatrixD::Zero(60, 3);
  scene.velocity.bottomRows(59) = (scene.root.bottomRows(59) - scene.root.topRows(59)) * fps;
  return scene;
}

double rms(const MatrixD& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("root trajectory: joints that are hardly trusted hardly pull") {
  const Scene clean = make_scene();
  Scene trusted = clean;
  for (const int joint : {3, 4, 6, 7, 11, 13}) trusted.track.x_px.col(joint).array() += 8;
  Scene doubted = trusted;
  for (const int joint : {3, 4, 6, 7, 11, 13})
    doubted.track.confidence.col(joint).setConstant(1e-4);
  CHECK(rms(trusted.solve() - clean.root) > 0.5);
  CHECK(rms(doubted.solve() - clean.root) < 0.05 * rms(trusted.solve() - clean.root));
}

TEST_CASE("root trajectory: a velocity counts by its error") {
  Scene scene = make_scene();
  add_pixel_noise(scene.track, 4, 3);
  // The right velocity: believed it leaves a smooth path at the right speed, doubted a rough one.
  const auto roughness = [&](double velocity_error_m_s2) {
    const MatrixD off = scene.solve(velocity_error_m_s2) - scene.root;
    return rms(off.bottomRows(58) - 2 * off.middleRows(1, 58) + off.topRows(58));
  };
  CHECK(roughness(0.01) < 0.05 * roughness(1));
  CHECK(roughness(1) < 0.3 * roughness(100));
}

TEST_CASE("root trajectory: neither the file's unit nor the frame rate's changes the answer") {
  const auto noisy = [](Scene scene) {
    add_pixel_noise(scene.track, 3, 5);
    return scene;
  };
  const MatrixD centimetres = noisy(make_scene(1)).solve(),
                metres = noisy(make_scene(0.01)).solve();
  CHECK((centimetres - 100 * metres).cwiseAbs().maxCoeff() < 1e-6);
  // The same track in half the time, at twice the speed: an error of four times the acceleration
  // is as much a frame.
  Scene fast = noisy(make_scene());
  const MatrixD slow = fast.solve(1);
  fast.track.fps *= 2;
  fast.velocity *= 2;
  // Only the bound on speed differs, which hardly counts.
  CHECK((fast.solve(4) - slow).cwiseAbs().maxCoeff() < 1e-2);
}

}  // namespace root_trajectory_weights_test
