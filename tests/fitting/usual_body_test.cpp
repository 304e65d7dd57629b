#include "fitting/usual_body.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "features/clip_modalities.hpp"
#include "fitting/sliding_fit.hpp"
#include "fitting/two_second_walk.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/body_size.hpp"

namespace usual_body_test {

using namespace mcdbn;

namespace {

double length(const Skeleton& skeleton, JointRole role) {
  return skeleton.joints[static_cast<std::size_t>(humanoid_roles().joint(role))].offset.norm();
}

/// Every joint turns a little about its rest.
Motion moving_humanoid() {
  Motion motion{canonical_humanoid(), 1.0 / 30, {}};
  const int channels = motion.skeleton.channel_count();
  motion.channels = MatrixD::Zero(24, channels);
  for (int t = 0; t < 24; ++t)
    for (int c = 3; c < channels; ++c) motion.channels(t, c) = 8 * std::sin(0.3 * t + c);
  motion.channels.col(1).setConstant(95);
  return motion;
}

}  // namespace

TEST_CASE("usual body: as tall as the humanoid, alike on both sides, every bone on its way") {
  const Skeleton &was = canonical_humanoid(), now = usual_body(was);
  DOCTEST_CHECK(is_humanoid(now));
  DOCTEST_CHECK(body_height(now) == doctest::Approx(body_height(was)).epsilon(0.005));
  for (const auto& [left, right] : {std::pair{JointRole::left_hip, JointRole::right_hip},
                                    {JointRole::left_knee, JointRole::right_knee},
                                    {JointRole::left_ankle, JointRole::right_ankle},
                                    {JointRole::left_clavicle, JointRole::right_clavicle},
                                    {JointRole::left_shoulder, JointRole::right_shoulder},
                                    {JointRole::left_elbow, JointRole::right_elbow},
                                    {JointRole::left_wrist, JointRole::right_wrist}})
    DOCTEST_CHECK(length(now, left) == doctest::Approx(length(now, right)));
  // What one orientation turns has one length in the fit: all of it changes alike.
  for (const auto& [one, other] : {std::pair{JointRole::spine, JointRole::left_hip},
                                   {JointRole::neck, JointRole::left_clavicle}})
    DOCTEST_CHECK(length(now, one) / length(was, one) ==
                  doctest::Approx(length(now, other) / length(was, other)));
  for (std::size_t joint = 0; joint < now.joints.size(); ++joint)
    DOCTEST_CHECK(now.joints[joint].offset.cross(was.joints[joint].offset).norm() < 1e-9);
}

TEST_CASE("usual body: where a detector shows the humanoid, and no skeleton is given") {
  const Modalities humanoid = test::modalities_of({moving_humanoid()}, {});
  const Skeleton usual = usual_body(canonical_humanoid());
  const auto elbow = [&](const KnownOfClip& known, const Modalities& modalities) {
    return length(body_to_begin_with(known, modalities), JointRole::left_elbow);
  };
  KnownOfClip known;
  DOCTEST_CHECK(elbow(known, humanoid) == length(canonical_humanoid(), JointRole::left_elbow));
  known.detected = true;
  DOCTEST_CHECK(elbow(known, humanoid) == length(usual, JointRole::left_elbow));
  known.camera = place_camera(moving_humanoid(), {});
  const Track2d track = project_motion(moving_humanoid(), *known.camera);
  DOCTEST_CHECK(length(SlidingFit(humanoid, known, track, {}).body(), JointRole::left_elbow) ==
                length(usual, JointRole::left_elbow));  // live, too
  const Modalities own = test::modalities_of({test::two_second_walk()}, {});
  const Skeleton begun = body_to_begin_with(known, own);
  for (std::size_t joint = 0; joint < begun.joints.size(); ++joint)
    DOCTEST_CHECK(begun.joints[joint].offset == own.pose_features.skeleton().joints[joint].offset);
  known.skeleton = canonical_humanoid();
  DOCTEST_CHECK(elbow(known, humanoid) == length(canonical_humanoid(), JointRole::left_elbow));
}

TEST_CASE("usual body: bones that a detector never shows keep its proportions in the answer") {
  const Motion motion = moving_humanoid();
  const Modalities modalities = test::modalities_of({motion}, {});
  KnownOfClip known{place_camera(motion, {}), {}};
  Track2d track = project_motion(motion, *known.camera);
  for (const char* joint :
       {"left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hand", "right_hand"})
    track.confidence.col(track.find(joint)).setZero();
  const MatrixF mean = MatrixF::Zero(track.frames(), modalities.pose_scale.output_dimension());
  const auto upper_arms = [&](const std::optional<TrackFitSettings>& settings) {
    const Skeleton body = fit_to_track(mean, modalities, track, known, settings).motion.skeleton;
    return length(body, JointRole::left_elbow) / length(body, JointRole::left_hand);
  };
  const auto of = [&](const Skeleton& body) {
    return length(body, JointRole::left_elbow) / length(body, JointRole::left_hand);
  };
  known.detected = true;
  DOCTEST_CHECK(upper_arms(TrackFitSettings{}) == doctest::Approx(of(usual_body(motion.skeleton))));
  DOCTEST_CHECK(upper_arms(std::nullopt) == doctest::Approx(of(motion.skeleton)));
  known.detected = false;
  DOCTEST_CHECK(upper_arms(TrackFitSettings{}) == doctest::Approx(of(motion.skeleton)));
}

}  // namespace usual_body_test
