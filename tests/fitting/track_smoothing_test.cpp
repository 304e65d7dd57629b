#include "fitting/track_smoothing.hpp"

#include "camera/track_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mcdbn/camera/camera.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;

namespace {

Track2d track_of(int frames) {
  const Motion motion = test::swinging(test::small_body(), frames);
  return project_motion(motion, place_camera(motion, {}));
}

}  // namespace

TEST_CASE("a track's noise is measured from the track") {
  // Straight lines have no third differences but the noise's.
  Track2d track = track_of(2);
  const Eigen::Index frames = 1000, joints = track.joint_count();
  track.x_px = Eigen::VectorXd::LinSpaced(frames, 0, 900).replicate(1, joints);
  track.y_px = track.x_px;
  track.confidence = MatrixD::Ones(frames, joints);
  CHECK(track_noise_px(track) < 1e-9);
  add_pixel_noise(track, 3, 1);
  // 28000 third differences, one in some four independent: the deviation of the median's size is
  // 1.2 / sqrt(7000) of it; four of them.
  CHECK(track_noise_px(track) == doctest::Approx(3).epsilon(0.057));
  Track2d seldom = track;
  drop_joints(seldom, 0.3, 1);
  CHECK(track_noise_px(seldom) == doctest::Approx(3).epsilon(0.12));
  drop_joints(seldom, 1, 1);
  CHECK(track_noise_px(seldom) == 0);
}

TEST_CASE("smoothing a track takes noise out, and leaves a clean one and its gaps alone") {
  const Track2d clean = track_of(200);
  const auto rms = [&](const Track2d& track) {
    const MatrixD off = (track.x_px.array().isNaN()).select(0, track.x_px - clean.x_px);
    return std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
  };
  CHECK(rms(smooth_track(clean)) < 0.25);
  Track2d noisy = clean;
  add_pixel_noise(noisy, 5, 1);
  CHECK(rms(smooth_track(noisy)) < 0.9 * rms(noisy));
  drop_joints(noisy, 0.2, 1);
  const Track2d smooth = smooth_track(noisy);
  CHECK((smooth.x_px.array().isNaN() == noisy.x_px.array().isNaN()).all());
  CHECK(smooth.confidence == noisy.confidence);
  CHECK(smooth_track(track_of(1)).x_px.allFinite());
}

TEST_CASE("a joint that lies astray now and then with little confidence is smoothed as else") {
  Track2d track = track_of(2);
  constexpr Eigen::Index kFrames = 300;
  const Eigen::Index joints = track.joint_count();
  track.x_px = Eigen::VectorXd::LinSpaced(kFrames, 0, 300).replicate(1, joints);
  track.y_px = track.x_px;
  track.confidence = MatrixD::Ones(kFrames, joints);
  const MatrixD clean = track.x_px;
  add_pixel_noise(track, 3, 1);
  const auto rms = [&](const Track2d& answer) {
    double squares = 0;
    int count = 0;
    for (Eigen::Index t = 0; t < kFrames; ++t) {
      if (t % 40 > 8 && t % 40 < 32) continue;  // near those that lie astray, below
      squares += (answer.x_px.row(t) - clean.row(t)).squaredNorm();
      count += static_cast<int>(joints);
    }
    return std::sqrt(squares / count);
  };
  const double usual = rms(smooth_track(track));
  const auto astray = [&](double confidence) {
    Track2d some = track;
    for (Eigen::Index t = 20; t < kFrames; t += 40) {
      some.x_px.row(t).array() += 120;
      some.confidence.row(t).setConstant(confidence);
    }
    return rms(smooth_track(some));
  };
  CHECK(astray(1) > 2 * usual);
  CHECK(astray(1e-3) < 1.2 * usual);
}
