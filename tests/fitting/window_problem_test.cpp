// What a window's problem does with joints that nothing shows.

#include "fitting/window_problem.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "fitting/prior_errors.hpp"

namespace window_problem_test {

using namespace mcdbn;

namespace {

constexpr Eigen::Index kFrames = 12;
const RayNoise kNoise{0.002, 0.004};

/// A thigh whose knee is seen as it swings, and a shank whose ankle no frame shows. The ankle
/// stands.
PosteriorClip hidden_ankle() {
  PosteriorClip clip;
  clip.parents = {-1, 0};
  clip.lengths = {0, 1};
  clip.root = MatrixD::Zero(kFrames, 3);
  clip.root.col(2).setConstant(4);
  clip.travelled = clip.root;
  clip.feet = {1};
  clip.grounds = {0};
  clip.planted = MatrixD::Ones(kFrames, 1);
  clip.frame_time_s = 1.0 / 30;
  clip.turn_deviation_rad = MatrixD::Constant(kFrames, 2, 0.2);
  clip.body_unknown = true;
  for (Eigen::Index t = 0; t < kFrames; ++t) {
    const double turn = 0.3 * std::sin(0.4 * static_cast<double>(t));
    const Eigen::Vector2d knee(-0.4 * std::sin(turn) / 4, 0.4 * std::cos(turn) / 4);
    clip.seen.push_back(
        {{{{0, {0, 0.4, 0}}}, knee, 1}, {{{0, {0, 0.4, 0}}, {1, {0, 0.4, 0}}}, {0, 0}, 0}});
  }
  return clip;
}

PosteriorPoint solved(const PosteriorClip& clip, const PosteriorPoint& from) {
  WindowProblem problem(clip, kNoise, {}, from, 0, kFrames);
  problem.solve(true, 1e-6);
  return problem.solution();
}

}  // namespace

TEST_CASE("window problem: a foot that no frame shows changes nothing") {
  PosteriorClip with = hidden_ankle(), without = with;
  without.feet.clear();
  without.grounds.clear();
  without.planted = MatrixD::Zero(kFrames, 0);
  const PosteriorPoint one = solved(with, PosteriorPoint::zero(with)),
                       other = solved(without, PosteriorPoint::zero(without));
  DOCTEST_CHECK(one.shift.norm() > 0.01);
  DOCTEST_CHECK((one.turns - other.turns).norm() < 1e-9);
  DOCTEST_CHECK((one.shift - other.shift).norm() < 1e-9);
  DOCTEST_CHECK((one.log_lengths - other.log_lengths).norm() < 1e-9);
  for (SeenJoint* ankle : {&with.seen[3][1], &with.seen[4][1]}) {
    ankle->ray = {0, 0.2};
    ankle->confidence = 1;
  }
  DOCTEST_CHECK((solved(with, PosteriorPoint::zero(with)).turns - one.turns).norm() > 1e-3);
}

TEST_CASE("window problem: what moves no seen joint leans with the camera no more than its mean") {
  for (const double leant : {0.0, 0.1, 0.25}) {
    CAPTURE(leant);
    PosteriorClip clip = hidden_ankle();
    clip.camera = UnknownCamera{};
    clip.camera->pitch_known = clip.camera->roll_known = true;
    clip.mean_lean = MatrixD::Zero(kFrames, 3);
    clip.mean_lean.col(0).setConstant(leant);
    PosteriorPoint from = PosteriorPoint::zero(clip);
    from.lean.x() = 0.25;
    const PosteriorPoint found = solved(clip, from);
    const PriorErrors prior(clip, kNoise, {});
    const double share = prior.share_of_parent(0, 1);
    for (Eigen::Index t = 0; t < kFrames; ++t) {
      const Eigen::Vector3d parent = found.turns.row(t).head<3>().transpose(),
                            own = found.turns.row(t).tail<3>().transpose();
      DOCTEST_CHECK(
          (own - share * parent - (1 - share) * Eigen::Vector3d(0.25 - leant, 0, 0)).norm() < 1e-9);
    }
  }
}

TEST_CASE("window problem: turns that follow the lean that the mean was seen by cost nothing") {
  PosteriorClip clip = hidden_ankle();
  clip.feet.clear();
  clip.grounds.clear();
  clip.planted = MatrixD::Zero(kFrames, 0);
  for (auto& frame : clip.seen)
    for (SeenJoint& joint : frame) joint.confidence = 0;
  clip.camera = UnknownCamera{};
  const Eigen::Vector3d lean(0.25, 0, 0);
  const auto energy = [&](Eigen::Index last_held) {
    clip.mean_lean = MatrixD::Zero(kFrames, 3);
    PosteriorPoint from = PosteriorPoint::zero(clip);
    from.lean = lean;
    for (Eigen::Index t = 0; t < kFrames; ++t) {
      if (t > last_held) clip.mean_lean.row(t) << 0.1, 0, -0.05;
      for (Eigen::Index turn = 0; turn < from.turns.cols() / 3; ++turn)
        from.turns.row(t).segment<3>(3 * turn) = lean.transpose() - clip.mean_lean.row(t);
    }
    return WindowProblem(clip, kNoise, {}, from, 0, kFrames, Unknowns::all).energy();
  };
  const double steady = energy(kFrames);
  for (const Eigen::Index last_held : {0, 2, 5}) {
    CAPTURE(last_held);
    DOCTEST_CHECK(std::abs(energy(last_held) - steady) < 1e-9);
  }
}

TEST_CASE("window problem: how far a bone's length strays, by what it is of and what is seen") {
  TrackFitSettings settings;
  settings.bone_log_deviation = 0.5;
  settings.arm_log_deviation = 0.25;
  settings.leg_log_deviation = 0.0625;
  settings.partial_body_log_deviation = 0.125;
  /// ½ (0.1 / deviation)² of the first length, the only one that is not 0.
  const auto deviation = [&](const PosteriorClip& clip, Unknowns unknowns = Unknowns::seen) {
    const auto energy = [&](double log_length, double expected_deviation) {
      TrackFitSettings same = settings;
      same.bone_log_deviation = same.arm_log_deviation = same.leg_log_deviation =
          same.partial_body_log_deviation = expected_deviation;
      PosteriorPoint from = PosteriorPoint::zero(clip);
      from.log_lengths[0] = log_length;
      return WindowProblem(clip, kNoise, expected_deviation > 0 ? same : settings, from, 0, kFrames,
                           unknowns)
          .energy();
    };
    // All else is the same with any deviation.
    const double more = energy(0.1, 0) - energy(0.1, 1e3);
    return 0.1 / std::sqrt(2 * more);
  };
  PosteriorClip clip = hidden_ankle();
  clip.length_kinds = {BoneKind::other, BoneKind::other};
  DOCTEST_CHECK(deviation(clip) == doctest::Approx(0.5).epsilon(1e-3));
  for (const Unknowns unknowns : {Unknowns::seen, Unknowns::tracked, Unknowns::all}) {
    clip.length_kinds = {BoneKind::leg, BoneKind::leg};  // the thigh is seen
    DOCTEST_CHECK(deviation(clip, unknowns) == doctest::Approx(0.0625).epsilon(1e-3));
    clip.length_kinds = {BoneKind::other, BoneKind::leg};  // the leg's ankle is not, and stands
    DOCTEST_CHECK(deviation(clip, unknowns) == doctest::Approx(0.125).epsilon(1e-3));
  }
  clip.length_kinds = {BoneKind::arm, BoneKind::other};
  DOCTEST_CHECK(deviation(clip) == doctest::Approx(0.25).epsilon(1e-3));
}

TEST_CASE("window problem: heights of standing feet count by how sure and how many they are") {
  PosteriorClip clip = hidden_ankle();
  TrackFitSettings settings;
  /// What 0.2 m between the ankle and the ground cost.
  const auto cost = [&](double confidence, double observation_s) {
    clip.planted.setConstant(confidence);
    settings.ground_observation_s = observation_s;
    const auto energy = [&](double off_m) {
      PosteriorPoint from = PosteriorPoint::zero(clip);
      from.ground_m[0] = off_m - 0.8;  // both bones hang down
      return WindowProblem(clip, kNoise, settings, from, 0, kFrames, Unknowns::all).energy();
    };
    return energy(0.2) - energy(0);
  };
  const double whole = cost(1, clip.frame_time_s);
  DOCTEST_CHECK(whole > 1);
  DOCTEST_CHECK(cost(0.25, clip.frame_time_s) / whole == doctest::Approx(0.25));
  DOCTEST_CHECK(cost(1, 15 * clip.frame_time_s) / whole == doctest::Approx(1.0 / 15));
  DOCTEST_CHECK(cost(1, 0.1 * clip.frame_time_s) == doctest::Approx(whole));
}

TEST_CASE(
    "window problem: a foot that stands with a quarter of the confidence slips twice as far") {
  PosteriorClip clip = hidden_ankle();
  PosteriorPoint from = PosteriorPoint::zero(clip);
  from.ground_m[0] = -0.8;
  for (Eigen::Index t = 1; t < kFrames; t += 2) from.shift(t, 0) = 0.02;
  const auto energy = [&](double confidence, double speed_m_s) {
    clip.planted.setConstant(confidence);
    TrackFitSettings settings;
    settings.planted_foot_speed_m_s = speed_m_s;
    return WindowProblem(clip, kNoise, settings, from, 0, kFrames, Unknowns::all).energy();
  };
  const double quarter = energy(0.25, 0.5);
  DOCTEST_CHECK(std::abs(quarter - energy(1, 1.0)) < 1e-9 * quarter);
  DOCTEST_CHECK(energy(1, 0.5) > quarter + 0.1);
}

}  // namespace window_problem_test
