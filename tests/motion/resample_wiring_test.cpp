#include <doctest/doctest.h>

#include <cmath>

#include "motion/resample.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Channels in an order in which a position stands between two angles, a joint that only shifts,
/// and a hinge whose angle begins past a whole turn.
Motion clip(double fps, int frames) {
  Motion motion;
  motion.skeleton.joints = {
      make_joint("root", -1, {0, 0, 0}, {z_rotation, y_position, x_rotation, x_position}),
      make_joint("slider", 0, {1, 2, 3}, {z_position}),
      make_joint("hinge", 1, {0, 5, 0}, {y_rotation})};
  motion.frame_time_s = 1 / fps;
  motion.channels.resize(frames, 6);
  for (int t = 0; t < frames; ++t) {
    const double time_s = t / fps;
    motion.channels.row(t) << 0, 100 + 30 * time_s, -380 + 20 * time_s, 7 - 50 * time_s,
        40 * time_s, 400 + 60 * time_s;
  }
  return motion;
}

}  // namespace

TEST_CASE("resampled channels stand where they stood, and angles begin where the file's do") {
  for (const double hz : {25.0, 40.0, 100.0}) {
    for (const double phase : {0.0, 0.75}) {
      CAPTURE(hz);
      CAPTURE(phase);
      const Motion motion = clip(50, 101), result = resample(motion, hz, phase);
      CHECK(result.frame_time_s == doctest::Approx(1 / hz));
      REQUIRE(result.frames() == static_cast<int>(std::floor(2 * hz - phase + 1e-3)) + 1);
      for (int t = 0; t < result.frames(); ++t) {
        // A steady motion passes the filter as it is, but for an angle's bend in quaternions.
        const Motion want = clip(hz / (t + phase), 2);
        for (const int column : {1, 3, 4})
          CHECK(std::abs(result.channels(t, column) - want.channels(1, column)) < 1e-9);
        for (const int column : {0, 2, 5})
          CHECK(std::abs(result.channels(t, column) - want.channels(1, column)) < 0.2);
      }
    }
  }
}

TEST_CASE("a clip without its first frame keeps its rate and its body") {
  const Motion motion = clip(50, 3), rest = without_first_frame(motion);
  CHECK(rest.frame_time_s == motion.frame_time_s);
  CHECK(rest.skeleton.joint_count() == 3);
  CHECK(rest.channels == motion.channels.bottomRows(2));
}
