// A solution of a few frames a second stands in for one of all.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "fitting/clip_posterior.hpp"

namespace coarse_solution_test {

using namespace mcdbn;

namespace {

constexpr double kRate_hz = 30;
constexpr Eigen::Index kEvery = 3;  // frames of first_solution_step_s
const RayNoise kNoise{0.002, 0.004};

/// Two bones that swing in the image, of which the lower one's end is seen and stands now and then.
/// The prior takes them for still.
PosteriorClip swinging(Eigen::Index frames) {
  PosteriorClip clip;
  clip.parents = {-1, 0};
  clip.lengths = {0, 1};
  clip.root = MatrixD::Zero(frames, 3);
  clip.root.col(2).setConstant(4);
  clip.travelled = clip.root;
  clip.feet = {1};
  clip.grounds = {0};
  clip.frame_time_s = 1 / kRate_hz;
  clip.turn_deviation_rad.resize(frames, 2);
  clip.planted.resize(frames, 1);
  for (Eigen::Index t = 0; t < frames; ++t) {
    clip.turn_deviation_rad.row(t).setConstant(0.2 + 0.01 * static_cast<double>(t % 7));
    clip.planted(t, 0) = t % 7 == 2 ? 0.3 : 0.9;
    const double turn = 0.3 * std::sin(3.0 * static_cast<double>(t) / kRate_hz);
    const Eigen::Vector3d knee(-0.4 * std::sin(turn), 0.4 * std::cos(turn), 4),
        ankle = knee + Eigen::Vector3d(-0.4 * std::sin(2 * turn), 0.4 * std::cos(2 * turn), 0);
    clip.seen.push_back({{{{0, {0, 0.4, 0}}}, knee.head<2>() / 4, 1},
                         {{{0, {0, 0.4, 0}}, {1, {0, 0.4, 0}}}, ankle.head<2>() / 4, 1}});
  }
  return clip;
}

/// Its every third frame, as a camera of 10 Hz has them.
PosteriorClip every_third(const PosteriorClip& clip) {
  PosteriorClip thin = clip;
  const Eigen::Index frames = (clip.frames() + kEvery - 1) / kEvery;
  for (const auto rows : {&PosteriorClip::turn_deviation_rad, &PosteriorClip::root,
                          &PosteriorClip::travelled, &PosteriorClip::planted})
    (thin.*rows).conservativeResize(frames, Eigen::NoChange);
  thin.seen.resize(static_cast<std::size_t>(frames));
  for (Eigen::Index k = 1; k < frames; ++k) {
    const Eigen::Index t = kEvery * k;
    thin.turn_deviation_rad.row(k) = clip.turn_deviation_rad.row(t);
    thin.seen[static_cast<std::size_t>(k)] = clip.seen[static_cast<std::size_t>(t)];
    double confidence = 1;  // stands throughout
    for (Eigen::Index step = t - kEvery + 1; step <= t; ++step)
      confidence = std::min(confidence, clip.planted(step, 0));
    thin.planted(k, 0) = confidence;
  }
  thin.frame_time_s = kEvery / kRate_hz;
  return thin;
}

/// Straight between the likeliest of every third frame, which are solved in windows of few frames.
void check_between_thirds(Eigen::Index frames, std::size_t windows) {
  const PosteriorClip clip = swinging(frames), thin = every_third(clip);
  DOCTEST_REQUIRE(windows_of(thin.frames(), kFewFrames).size() == windows);
  PosteriorPoint from = PosteriorPoint::zero(clip), thin_from = PosteriorPoint::zero(thin);
  from.ground_m.setConstant(-0.8);
  thin_from.ground_m = from.ground_m;
  const PosteriorPoint rough = coarse_solution(clip, kNoise, {}, from),
                       expected =
                           map_solution(thin, kNoise, {}, thin_from, SharedUnknowns::to_be_found,
                                        kSmallGainOfCoarse, kFewFrames);
  DOCTEST_REQUIRE(rough.turns.rows() == frames);
  DOCTEST_CHECK(expected.turns.cwiseAbs().maxCoeff() > 0.1);
  constexpr double kClose = 1e-12;
  for (Eigen::Index t = 0; t < frames; ++t) {
    CAPTURE(t);
    const Eigen::Index before = t / kEvery, after = std::min(before + 1, expected.turns.rows() - 1);
    const double share = static_cast<double>(t % kEvery) / kEvery;
    const auto straight = [&](const MatrixD& rows) {
      return ((1 - share) * rows.row(before) + share * rows.row(after)).eval();
    };
    DOCTEST_CHECK((rough.turns.row(t) - straight(expected.turns)).cwiseAbs().maxCoeff() < kClose);
    DOCTEST_CHECK((rough.shift.row(t) - straight(expected.shift)).cwiseAbs().maxCoeff() < kClose);
  }
  DOCTEST_CHECK(std::abs(rough.ground_m[0] - expected.ground_m[0]) < kClose);
}

}  // namespace

TEST_CASE("coarse solution: it is the likeliest of every third frame, straight between them") {
  check_between_thirds(44, 1);  // the last frame lies beyond the last of every third
}

TEST_CASE("coarse solution: a long clip's windows have few frames") {
  constexpr Eigen::Index kFrames = 600;
  REQUIRE(windows_of((kFrames + kEvery - 1) / kEvery).size() == 1);
  check_between_thirds(kFrames, 2);
}

TEST_CASE("coarse solution: how the camera leaned is that of every third frame") {
  PosteriorClip clip = swinging(44);
  clip.camera = UnknownCamera{};
  clip.mean_lean = MatrixD::Zero(44, 3);
  for (Eigen::Index t = 0; t < 44; ++t) clip.mean_lean(t, 0) = 0.01 * static_cast<double>(t);
  PosteriorClip thin = every_third(clip);
  for (Eigen::Index k = 0; k < thin.frames(); ++k)
    thin.mean_lean.row(k) = clip.mean_lean.row(kEvery * k);
  const PosteriorPoint rough = coarse_solution(clip, kNoise, {}, PosteriorPoint::zero(clip)),
                       expected = map_solution(thin, kNoise, {}, PosteriorPoint::zero(thin),
                                               SharedUnknowns::to_be_found, kSmallGainOfCoarse);
  CHECK(expected.lean.norm() > 0.01);
  CHECK((rough.lean - expected.lean).norm() < 1e-12);
  CHECK((rough.turns.row(0) - expected.turns.row(0)).norm() < 1e-12);
}

TEST_CASE("coarse solution: a clip whose frames are as far apart as that is solved as it is") {
  PosteriorClip clip = swinging(10);
  clip.frame_time_s = TrackFitSettings{}.first_solution_step_s;
  const PosteriorPoint from = PosteriorPoint::zero(clip);
  const PosteriorPoint rough = coarse_solution(clip, kNoise, {}, from),
                       full = map_solution(clip, kNoise, {}, from, SharedUnknowns::to_be_found,
                                           kSmallGainOfCoarse);
  CHECK(rough.turns == full.turns);
}

}  // namespace coarse_solution_test
