#include "motion/resample.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A root that travels and turns about z, x, y, and a hinge below it; channels
/// 0–2 position, 3–5 rotation, 6 the hinge.
Motion clip_of(double fps, int frames, const std::function<double(int, double)>& channel_at) {
  Motion motion;
  Joint root, hinge;
  root.name = "root";
  root.channels = {Channel::x_position, Channel::y_position, Channel::z_position,
                   Channel::z_rotation, Channel::x_rotation, Channel::y_rotation};
  hinge.name = "hinge";
  hinge.parent = 0;
  hinge.channels = {Channel::x_rotation};
  motion.skeleton.joints = {root, hinge};
  motion.frame_time_s = 1 / fps;
  motion.channels.resize(frames, 7);
  for (int frame = 0; frame < frames; ++frame) {
    for (int channel = 0; channel < 7; ++channel) {
      motion.channels(frame, channel) = channel_at(channel, frame / fps);
    }
  }
  return motion;
}

}  // namespace

TEST_CASE("what is below the cut-off keeps its amplitude and is not delayed") {
  const auto wave = [](int channel, double t) {
    if (channel == 3) return 30 * std::sin(kTurn * 2.0 * t);
    if (channel == 0) return 10 * std::cos(kTurn * 5.0 * t);
    return channel == 6 ? 200 * t : 0.0;  // the hinge turns on at a steady pace
  };
  const Motion slow = resample(clip_of(120, 481, wave), 30);
  REQUIRE(slow.frames() == 121);
  CHECK(slow.frame_time_s == doctest::Approx(1.0 / 30));
  for (int frame = 10; frame < 111; ++frame) {
    CHECK(std::abs(slow.channels(frame, 3) - wave(3, frame / 30.0)) < 0.1);
    CHECK(std::abs(slow.channels(frame, 0) - wave(0, frame / 30.0)) < 0.05);
  }
  for (int frame = 0; frame < 121; ++frame) {
    CHECK(std::abs(slow.channels(frame, 6) - wave(6, frame / 30.0)) < 1.0);
    CHECK(slow.channels(frame, 1) == 0);
  }
}

TEST_CASE("what the new rate cannot hold is removed, not folded back") {
  const auto wave = [](int channel, double t) {
    if (channel == 0) return 10 * std::cos(kTurn * 25.0 * t);
    return channel == 4 || channel == 6 ? 10 * std::sin(kTurn * 29.0 * t) : 0.0;
  };
  const Motion slow = resample(clip_of(120, 481, wave), 30);
  CHECK(slow.channels.middleRows(10, 100).cwiseAbs().maxCoeff() < 0.1);
}

TEST_CASE("a steady walk keeps its speed and its ends") {
  const auto walk = [](int channel, double t) { return channel == 2 ? 7 + 120 * t : 0.0; };
  const Motion slow = resample(clip_of(120, 101, walk), 25);
  REQUIRE(slow.frames() == 21);
  for (int frame = 0; frame < slow.frames(); ++frame) {
    CHECK(slow.channels(frame, 2) == doctest::Approx(walk(2, frame / 25.0)));
  }
}

TEST_CASE("going up interpolates along the shortest turn, and angles stay continuous") {
  // From 170° to 190°, written as −170°.
  const auto swing = [](int channel, double t) {
    if (channel == 0) return 10 * t;
    return channel == 3 ? (t < 0.05 ? 170.0 : -170.0) : 0.0;
  };
  const Motion fast = resample(clip_of(10, 2, swing), 40);
  REQUIRE(fast.frames() == 5);
  for (int frame = 0; frame < 5; ++frame) {
    CHECK(fast.channels(frame, 3) == doctest::Approx(170 + 5 * frame));
    CHECK(fast.channels(frame, 0) == doctest::Approx(0.25 * frame));
  }
}

TEST_CASE("phase shifts the grid by fractions of the new frame") {
  const auto ramp = [](int channel, double t) { return channel == 0 ? t : 0.0; };
  const Motion motion = clip_of(120, 121, ramp);
  const Motion shifted = resample(motion, 30, 0.5);
  REQUIRE(shifted.frames() == 30);
  CHECK(shifted.channels(0, 0) == doctest::Approx(0.5 / 30));
  CHECK(shifted.channels(29, 0) == doctest::Approx(29.5 / 30));
  const Motion same_rate = resample(motion, 120, 0.25);
  CHECK(same_rate.channels(7, 0) == doctest::Approx(7.25 / 120));
}

TEST_CASE("clips at the rate asked for, and clips of one frame") {
  const auto ramp = [](int channel, double t) { return channel == 0 ? t : 371.0; };
  const Motion near = clip_of(29.97, 20, ramp);
  const Motion unchanged = resample(near, 30);
  CHECK(resample(near, 30, 0, kSameRate).fps() == doctest::Approx(30).epsilon(1e-9));
  CHECK(unchanged.channels == near.channels);
  CHECK(unchanged.frame_time_s == near.frame_time_s);

  const Motion one = clip_of(120, 1, ramp);
  for (const double phase : {0.0, 0.7}) {
    for (const double rate : {30.0, 240.0}) {
      const Motion result = resample(one, rate, phase);
      REQUIRE(result.frames() == 1);
      CHECK(result.channels == one.channels);
      CHECK(result.frame_time_s == doctest::Approx(1 / rate));
    }
  }
  CHECK(resample(clip_of(120, 3, ramp), 30).frames() == 1);
}

TEST_CASE("senseless rates are refused") {
  const Motion motion = clip_of(120, 5, [](int, double t) { return t; });
  CHECK_THROWS_AS(resample(motion, 0), ConfigError);
  CHECK_THROWS_AS(resample(motion, -30), ConfigError);
  CHECK_THROWS_AS(resample(motion, std::nan("")), ConfigError);
  CHECK_THROWS_AS(resample(motion, 30, 1.0), ConfigError);
  CHECK_THROWS_AS(resample(motion, 30, -0.1), ConfigError);
  CHECK_THROWS_AS(resample(Motion{motion.skeleton, 0.01, MatrixD(0, 7)}, 30), ShapeError);
}

TEST_CASE("a calibration pose is an authored one that the clip jumps away from") {
  const auto walk = [](int, double t) { return 25.3 + 40 * t; };
  Motion motion = clip_of(120, 10, walk);
  CHECK_FALSE(has_leading_calibration_pose(motion));
  motion.channels.row(0).setZero();
  CHECK(has_leading_calibration_pose(motion));
  CHECK(without_first_frame(motion).channels == motion.channels.bottomRows(9));
  CHECK_FALSE(has_leading_calibration_pose(without_first_frame(motion)));
  motion.channels(0, 4) = -21;  // a whole degree, as CMU's hips have
  CHECK(has_leading_calibration_pose(motion));
  motion.channels(0, 4) = -21.3;
  CHECK_FALSE(has_leading_calibration_pose(motion));

  // Motion that starts from rest only creeps away.
  const Motion rest = clip_of(30, 10, [](int, double t) { return 300 * t * t; });
  CHECK_FALSE(has_leading_calibration_pose(rest));
  CHECK_FALSE(has_leading_calibration_pose(clip_of(30, 1, walk)));
  CHECK_THROWS_AS(without_first_frame(clip_of(30, 1, walk)), ShapeError);
}

TEST_CASE("calibration poses of the shared files") {
  if (!test::have_shared_data("cmu/walk", "calibration poses")) return;
  for (const auto& entry : std::filesystem::directory_iterator(test::shared_data() / "cmu/walk")) {
    CAPTURE(entry.path().filename().string());
    const Motion motion = read_bvh(entry.path());
    CHECK(has_leading_calibration_pose(motion));
    CHECK_FALSE(has_leading_calibration_pose(without_first_frame(motion)));
  }
  for (const char* folder : {"bandai/wave_both_hands", "bandai/wave_right_hand"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test::shared_data() / folder)) {
      CHECK_FALSE(has_leading_calibration_pose(read_bvh(entry.path())));
    }
  }
}

TEST_CASE("frames at another rate: as many as fit, and rates and numbers that are none") {
  CHECK(frames_at_rate(31, 30, 60, 0, 0) == 61);
  CHECK(frames_at_rate(31, 30, 10, 0, 0) == 11);
  CHECK(frames_at_rate(31, 30, 10, 0.5, 0) == 10);
  CHECK(frames_at_rate(1, 0.1, 10'000, 0, 0) == 1);
  CHECK(frames_at_rate(100, 0.1, 10'000, 0, 0) == 9'900'001);
  CHECK_THROWS_AS(frames_at_rate(102, 0.1, 10'000, 0, 0), InputError);
  CHECK_THROWS_AS(frames_at_rate(2'000'000'000, 0.1, 10'000, 0, 0), InputError);
  for (const double rate : {0.0, -30.0, 1e-300, 0.0999, 10'000.1, 1e300, std::nan("")}) {
    CAPTURE(rate);
    CHECK_THROWS_AS(frames_at_rate(10, rate, 30, 0, 0), ConfigError);
    CHECK_THROWS_AS(frames_at_rate(10, 30, rate, 0, 0), ConfigError);
    CHECK_THROWS_AS(resample(clip_of(30, 5, [](int, double) { return 0.0; }), rate), ConfigError);
  }
}

TEST_CASE("a real walk at 30 frames a second stays where it was") {
  if (!test::have_shared_data("cmu/walk/08_09.bvh", "resampled walk")) return;
  const Motion walk = without_first_frame(read_bvh(test::shared_data() / "cmu/walk/08_09.bvh"));
  const Motion slow = resample(walk, 30);
  const MatrixD before = joint_positions(walk), after = joint_positions(slow);
  double squares = 0;
  for (int frame = 0; frame < slow.frames(); ++frame) {
    squares += (after.row(frame) - before.row(4 * frame)).squaredNorm();
  }
  const double rms = std::sqrt(squares / static_cast<double>(after.size()) * 3);
  CHECK(rms < 0.1);  // file units: 6 mm, what lies above 10 Hz
  // Nothing that stood still in the file moves now, and no angle jumps.
  for (int column = 0; column < slow.channels.cols(); ++column) {
    const bool constant = (walk.channels.col(column).array() == walk.channels(0, column)).all();
    if (constant) CHECK((slow.channels.col(column).array() == walk.channels(0, column)).all());
  }
  const MatrixD steps =
      slow.channels.bottomRows(slow.frames() - 1) - slow.channels.topRows(slow.frames() - 1);
  CHECK(steps.cwiseAbs().maxCoeff() < 180);
}
