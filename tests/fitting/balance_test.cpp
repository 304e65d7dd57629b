// How sure a body's balance is of where up is.

#include <doctest/doctest.h>

#include <cmath>

#include "base/numbers.hpp"
#include "camera/track_rays.hpp"
#include "fitting/clip_evidence.hpp"
#include "fitting/tracked_joints.hpp"
#include "fitting/walk_scene.hpp"
#include "motion/body_size.hpp"

namespace balance_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// The root goes `speed_m_s` straight on, whatever the limbs do.
ClipEvidence evidence_of(double speed_m_s, int frames) {
  const Scene scene = make_scene(0, frames);
  Motion motion = scene.truth;
  const double units_per_m = file_units_per_metre(motion.skeleton);
  for (int t = 0; t < frames; ++t) {
    motion.channels.row(t).head<3>() = scene.truth.channels.row(0).head<3>();
    motion.channels(t, 2) += speed_m_s * units_per_m * t / motion.fps();
  }
  const std::vector<std::string> names = tracked_joints(scene.modalities.track_features);
  const Camera& camera = *scene.known.camera;
  return {scene.modalities.pose_features, motion, MatrixD::Zero(frames, 3),
          track_rays(names, project_motion(motion, camera), camera), camera};
}

double deviation_deg(double speed_m_s, int frames, double bent_legs = 0) {
  TrackFitSettings settings;
  settings.balance_deviation_deg = 4;
  settings.balance_speed_m_s = 2;
  settings.balance_bent_legs = 0.1;
  const ClipEvidence evidence = evidence_of(speed_m_s, frames);
  const ExpectedLean lean = evidence.balanced({evidence.clip.up, bent_legs}, settings);
  DOCTEST_CHECK(std::abs(lean.pitch) < 1e-9);
  DOCTEST_CHECK(lean.pitch_deviation == lean.roll_deviation);
  return lean.pitch_deviation / kRadiansPerDegree;
}

}  // namespace

TEST_CASE("balance: who moves fast leans, so it is less certain; in short clips, too") {
  for (const int frames : {60, 10, 2}) {
    CAPTURE(frames);
    DOCTEST_CHECK(deviation_deg(0, frames) == doctest::Approx(4));
    DOCTEST_CHECK(deviation_deg(2, frames) == doctest::Approx(8));
    DOCTEST_CHECK(deviation_deg(4, frames) == doctest::Approx(20));
  }
  DOCTEST_CHECK(deviation_deg(4, 1) == doctest::Approx(4));
}

TEST_CASE("balance: who sits or squats has the feet elsewhere, so it is less certain") {
  DOCTEST_CHECK(deviation_deg(0, 10, 0.1) == doctest::Approx(8));
  DOCTEST_CHECK(deviation_deg(0, 10, 0.3) == doctest::Approx(40));
  DOCTEST_CHECK(deviation_deg(2, 10, 0.1) == doctest::Approx(16));
}

}  // namespace balance_test
