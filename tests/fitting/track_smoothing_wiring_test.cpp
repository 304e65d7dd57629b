#include "fitting/track_smoothing.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "camera/track_noise.hpp"

namespace track_smoothing_wiring_test {

using namespace mcdbn;

namespace {

/// Two joints that move along lines, x and y and both joints in ways of their own.
Track2d lines(int frames) {
  Track2d track;
  track.joint_names = {"a", "b"};
  track.x_px = track.y_px = MatrixD(frames, 2);
  track.confidence = MatrixD::Ones(frames, 2);
  for (int t = 0; t < frames; ++t) {
    track.x_px.row(t) << 100 + 2 * t, 900 - t;
    track.y_px.row(t) << 50 + 3 * t, 200;
  }
  return track;
}

double rms(const MatrixD& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("smoothing: lines stay, and noise about them goes from both coordinates") {
  const Track2d clean = lines(150);
  const Track2d same = smooth_track(clean);
  CHECK((same.x_px - clean.x_px).cwiseAbs().maxCoeff() < 1e-3);
  CHECK((same.y_px - clean.y_px).cwiseAbs().maxCoeff() < 1e-3);
  Track2d noisy = clean;
  add_pixel_noise(noisy, 4, 1);
  const Track2d smooth = smooth_track(noisy);
  for (const auto px : {&Track2d::x_px, &Track2d::y_px})
    for (int joint = 0; joint < 2; ++joint)
      CHECK(rms((smooth.*px - clean.*px).col(joint)) <
            0.6 * rms((noisy.*px - clean.*px).col(joint)));
  CHECK(smooth.confidence == noisy.confidence);
  CHECK(smooth.fps == noisy.fps);
  CHECK(smooth.joint_names == noisy.joint_names);
}

TEST_CASE("smoothing: the frame rate is only a name for the time between frames") {
  Track2d track = lines(80);
  for (int t = 0; t < 80; ++t) track.x_px(t, 0) += 30 * std::sin(0.2 * t);
  add_pixel_noise(track, 2, 4);
  const Track2d slow = smooth_track(track);
  track.fps = 240;
  const Track2d fast = smooth_track(track);
  // But for the velocity that a series is thought to begin with.
  CHECK((slow.x_px - fast.x_px).cwiseAbs().maxCoeff() < 0.02);
  CHECK((slow.y_px - fast.y_px).cwiseAbs().maxCoeff() < 0.02);
  CHECK((slow.x_px - track.x_px).cwiseAbs().maxCoeff() > 1);
}

TEST_CASE("smoothing: a frame that is hardly trusted goes to where the others have it") {
  Track2d track = lines(60);
  add_pixel_noise(track, 2, 9);
  track.x_px(30, 0) += 20;
  const double believed = smooth_track(track).x_px(30, 0);
  track.confidence(30, 0) = 1e-3;
  const double doubted = smooth_track(track).x_px(30, 0);
  CHECK(std::abs(doubted - 160) < 2);
  CHECK(believed - doubted > 1);
}

TEST_CASE("smoothing: what is missing stays missing and takes no part") {
  Track2d track = lines(60);
  add_pixel_noise(track, 2, 9);
  Track2d wild = track;
  for (Track2d* either : {&track, &wild}) either->confidence(20, 1) = 0;
  track.x_px(20, 1) = track.y_px(20, 1) = std::numeric_limits<double>::quiet_NaN();
  wild.x_px(20, 1) = wild.y_px(20, 1) = 1e6;
  const Track2d a = smooth_track(track), b = smooth_track(wild);
  CHECK(std::isnan(a.x_px(20, 1)));
  CHECK(b.x_px(20, 1) == 1e6);
  CHECK(a.x_px.col(1).head(20) == b.x_px.col(1).head(20));
  CHECK(a.y_px.col(1).tail(39) == b.y_px.col(1).tail(39));
  CHECK(a.x_px.col(0) == b.x_px.col(0));
}

}  // namespace track_smoothing_wiring_test
