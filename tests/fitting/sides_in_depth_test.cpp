// Limbs whose side in depth a solution has wrong. CHECK is glog's here, as in terms_test.cpp.

#include "fitting/sides_in_depth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "fitting/limb_sides.hpp"
#include "fitting/window_problem.hpp"
#include "mcdbn/base/random.hpp"
#include "motion/rotation_vector.hpp"

namespace sides_in_depth_test {

using namespace mcdbn;

namespace {

constexpr Eigen::Index kFrames = 90;
constexpr double kDepth_m = 4;
const RayNoise kExact{2.5e-4, 0, true, false,
                      true};  // a quarter of a pixel of a focal length of 1,000

/// The arm's swing towards the camera (−) and away.
double swing_rad(Eigen::Index t) {
  return 0.8 * std::sin(0.15 * static_cast<double>(t));
}

/// An arm of two bones that hangs down in the prior's mean, and as a camera sees it that swings.
PosteriorClip swinging_arm(double (*angle_rad)(Eigen::Index) = swing_rad) {
  PosteriorClip clip;
  clip.parents = {-1, 0, 1};
  clip.lengths = {0, 1, 2};
  clip.root = MatrixD::Zero(kFrames, 3);
  clip.root.col(2).setConstant(kDepth_m);
  clip.travelled = clip.root;
  clip.planted = MatrixD::Zero(kFrames, 0);
  clip.turn_deviation_rad = MatrixD::Constant(kFrames, 3, 0.3);
  clip.frame_time_s = 1.0 / 30;
  const std::vector<Lever> shoulder{{0, {0.2, -0.5, 0}}};
  for (Eigen::Index t = 0; t < kFrames; ++t) {
    const Eigen::Matrix3d swung = rotation_of({angle_rad(t), 0, 0});
    std::vector<SeenJoint> seen;
    Eigen::Vector3d at = clip.root.row(t).transpose() + shoulder.front().bone;
    seen.push_back({shoulder, at.head<2>() / at.z(), 1});
    for (const double side : {-1, 1}) {  // hips, so that the body does not lean with the arm
      const Eigen::Vector3d hip(0.2 * side, 0.2, 0);
      const Eigen::Vector3d seen_at = clip.root.row(t).transpose() + hip;
      seen.insert(seen.begin(), {{{0, hip}}, seen_at.head<2>() / seen_at.z(), 1});
    }
    for (const int turn : {1, 2}) {
      std::vector<Lever> levers = seen.back().levers;
      levers.insert(levers.begin(), {turn, {0, 0.3, 0}});
      at += swung * levers.front().bone;
      seen.push_back({levers, at.head<2>() / at.z(), 1});
    }
    clip.seen.push_back(seen);
  }
  return clip;
}

/// A solution from where `turns` swing as the arm does in some frames, and the other way elsewhere.
PosteriorPoint solved_from(const PosteriorClip& clip, const std::vector<int>& turns,
                           const std::vector<int>& other_turns, bool (*other_way)(Eigen::Index)) {
  PosteriorPoint point = PosteriorPoint::zero(clip);
  for (Eigen::Index t = 0; t < kFrames; ++t) {
    for (const int turn : turns) point.turns(t, 3 * turn) = swing_rad(t);
    for (const int turn : other_turns)
      point.turns(t, 3 * turn) = (other_way(t) ? -1 : 1) * swing_rad(t);
  }
  return map_solution(clip, kExact, {}, point);
}

double worst_rad(const PosteriorPoint& point, int turn) {
  double worst = 0;
  for (Eigen::Index t = 0; t < kFrames; ++t)
    worst = std::max(worst, std::abs(point.turns(t, 3 * turn) - swing_rad(t)));
  return worst;
}

bool in_one_swing(Eigen::Index t) {
  return t >= 21 && t < 42;
}
bool in_two_swings(Eigen::Index t) {
  return t < 21 || (t >= 42 && t < 63);
}

}  // namespace

TEST_CASE("sides in depth: a swing to the wrong side is found and put right") {
  const PosteriorClip clip = swinging_arm();
  for (const auto other_way : {in_one_swing, in_two_swings})
    for (const bool both : {false, true}) {
      CAPTURE(both);
      const PosteriorPoint wrong =
          both ? solved_from(clip, {}, {1, 2}, other_way) : solved_from(clip, {1}, {2}, other_way);
      REQUIRE(worst_rad(wrong, 2) > 0.5);  // it does not come back by itself
      REQUIRE((worst_rad(wrong, 1) > 0.5) == both);
      const PosteriorPoint right = likeliest_in_depth(clip, kExact, {}, wrong);
      CHECK_UNARY(worst_rad(right, 1) < 0.1);
      CHECK_UNARY(worst_rad(right, 2) < 0.1);
      CHECK_UNARY(right.energy < wrong.energy);
      TrackFitSettings none;
      none.most_alternatives = 0;
      CHECK_UNARY(likeliest_in_depth(clip, kExact, none, wrong).turns == wrong.turns);
    }
}

TEST_CASE("sides in depth: what is right stays, and the same comes out again") {
  const PosteriorClip clip = swinging_arm();
  const PosteriorPoint right = solved_from(clip, {1, 2}, {}, in_one_swing);
  CHECK_UNARY(likeliest_in_depth(clip, kExact, {}, right).turns == right.turns);
  const PosteriorPoint wrong = solved_from(clip, {1}, {2}, in_two_swings);
  CHECK_UNARY(likeliest_in_depth(clip, kExact, {}, wrong).turns ==
              likeliest_in_depth(clip, kExact, {}, wrong).turns);
}

TEST_CASE("limb sides: bones that hang from each other; what is on the wrong side, and no more") {
  const PosteriorClip clip = swinging_arm();
  const std::vector<Limb> limbs = limbs_of(clip);
  REQUIRE_UNARY(limbs.size() == 1);  // the trunk has hips and shoulder
  REQUIRE_UNARY(limbs[0].size() == 2);
  CHECK_UNARY(limbs[0][0].turn == 1);
  CHECK_UNARY(limbs[0][1].turn == 2);
  const auto found = [&](const PosteriorPoint& point) {
    return likelier_sides(clip, kExact, {}, point, limbs[0]);
  };
  CHECK_UNARY(found(solved_from(clip, {1, 2}, {}, in_one_swing)).empty());
  const std::vector<OtherSides> others = found(solved_from(clip, {1}, {2}, in_one_swing));
  REQUIRE_UNARY(others.size() == 1);
  const ClipWindow& stretch = others[0].stretch;
  CHECK_UNARY(std::abs(stretch.first - 21) <= 2);
  CHECK_UNARY(std::abs(stretch.end() - 42) <= 2);
  for (Eigen::Index i = 0; i < stretch.frames; ++i)
    for (const Eigen::Index bone : {0, 1}) {
      const double wanted_rad = swing_rad(stretch.first + i);
      const Eigen::Vector3d turn = others[0].turns.row(i).segment<3>(3 * bone);
      CHECK_UNARY((turn - Eigen::Vector3d(wanted_rad, 0, 0)).norm() < 0.05);
    }
}

TEST_CASE("limb sides: a bone without a ray is mirrored, and two frames have no bend") {
  PosteriorClip clip = swinging_arm();
  const PosteriorPoint wrong = solved_from(clip, {1}, {2}, in_one_swing);
  for (Eigen::Index t = 28; t < 34; ++t)
    clip.seen[static_cast<std::size_t>(t)].back().confidence = 0;
  const Limb limb = limbs_of(clip).front();
  const std::vector<OtherSides> others = likelier_sides(clip, kExact, {}, wrong, limb);
  REQUIRE_UNARY(others.size() == 1);
  const ClipWindow& stretch = others[0].stretch;
  for (Eigen::Index t = 28; t < 34; ++t)
    CHECK_UNARY(std::abs(others[0].turns(t - stretch.first, 3) - swing_rad(t)) < 0.05);
  PosteriorClip two = clip;
  two.root = clip.root.topRows(2).eval();
  CHECK_UNARY(likelier_sides(two, kExact, {}, wrong, limb).empty());
}

TEST_CASE("limb sides: a camera that leans makes the side likelier that leans with it") {
  constexpr double kHeld_rad = 0.4;
  PosteriorClip clip = swinging_arm([](Eigen::Index) { return kHeld_rad; });
  clip.camera.emplace();
  const Limb limb = limbs_of(clip).front();
  const auto others = [&](double side, double lean_rad) {
    PosteriorPoint point = PosteriorPoint::zero(clip);
    for (const Eigen::Index turn : {1, 2}) point.turns.col(3 * turn).setConstant(side * kHeld_rad);
    point.lean.x() = lean_rad;
    return likelier_sides(clip, kExact, {}, point, limb);
  };
  CHECK_UNARY(others(1, kHeld_rad).empty());
  const std::vector<OtherSides> found = others(-1, kHeld_rad);
  REQUIRE_UNARY(found.size() == 1);
  CHECK_UNARY(found[0].stretch.frames == kFrames);
  CHECK_UNARY((found[0].turns.col(3).array() - kHeld_rad).abs().maxCoeff() < 0.05);
  // A mean that was seen by a camera that leans twice as far leans back.
  clip.mean_lean = MatrixD::Zero(kFrames, 3);
  clip.mean_lean.col(0).setConstant(2 * kHeld_rad);
  CHECK_UNARY(others(-1, kHeld_rad).empty());
  CHECK_UNARY(others(1, kHeld_rad).size() == 1);
}

TEST_CASE("exact rays: their noise is lowered while that costs next to nothing") {
  PosteriorClip clip = swinging_arm();
  const PosteriorPoint wrong = solved_from(clip, {1}, {2}, in_two_swings);
  constexpr double kLeast = 1e-5;
  RayNoise noise = kExact;
  const PosteriorPoint exact = likeliest_of_exact(clip, noise, {}, kLeast, wrong);
  CHECK_UNARY(noise.white == kLeast);
  CHECK_UNARY(noise.exact);
  CHECK_UNARY(noise.steady);
  CHECK_UNARY(worst_rad(exact, 1) < 0.02);
  CHECK_UNARY(worst_rad(exact, 2) < 0.02);

  for (std::size_t t = 0; t < clip.seen.size(); ++t)
    for (std::size_t k = 0; k < clip.seen[t].size(); ++k)
      for (const Eigen::Index axis : {0, 1})
        clip.seen[t][k].ray[axis] +=
            kExact.white / 2 *
            random_normal({7, static_cast<std::uint32_t>(axis), 0, 0},
                          static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(k));
  noise = kExact;
  const PosteriorPoint noisy = likeliest_of_exact(clip, noise, {}, kLeast, wrong);
  CHECK_UNARY(noise.white == kExact.white);
  RayNoise same = kExact;
  CHECK_UNARY(likeliest_in_depth(clip, same, {}, wrong).turns == noisy.turns);
}

TEST_CASE("window problem: some orientations alone, then all again, from another start") {
  const PosteriorClip clip = swinging_arm();
  const PosteriorPoint zero = PosteriorPoint::zero(clip);
  WindowProblem problem(clip, kExact, {}, zero, 10, 30);
  const double first = problem.energy();
  problem.solve_turns({2}, 1e-6, 20);
  const PosteriorPoint some = problem.solution();
  CHECK_UNARY(some.energy < first);
  CHECK_UNARY(problem.energy() == doctest::Approx(some.energy));
  CHECK_UNARY(some.shift.isZero(0));
  CHECK_UNARY(some.turns.leftCols(6).isZero(0));
  CHECK_UNARY(some.turns.rightCols(3).norm() > 0.1);
  problem.start_from(zero);
  CHECK_UNARY(problem.energy() == doctest::Approx(first));
  problem.solve(false, 1e-6);
  CHECK_UNARY(problem.solution().energy < some.energy);
  CHECK_UNARY(problem.solution().turns.middleCols(3, 3).norm() > 0.1);
}

TEST_CASE("window problem: where rays are exact the prior's mean counts for less") {
  PosteriorClip clip = swinging_arm();
  const auto followed = [&](bool is_exact, double counts) {
    TrackFitSettings settings;
    settings.exact_prior_weight = counts;
    const RayNoise noise{0.05, 0, is_exact};  // so far off that the prior counts
    const PosteriorPoint start = solved_from(clip, {1, 2}, {}, in_one_swing);
    return map_solution(clip, noise, settings, start).turns.norm();
  };
  CHECK_UNARY(followed(true, 0.3) > 1.05 * followed(false, 0.3));
  CHECK_UNARY(followed(true, 0.6) > 1.01 * followed(false, 0.3));
  CHECK_UNARY(followed(true, 1) == followed(false, 0.3));
}

}  // namespace sides_in_depth_test
