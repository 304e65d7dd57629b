// A clip of several windows: the one that shows most gives what they have in common, and where the
// others begin. CHECK is glog's here, as in terms_test.cpp.

#include <doctest/doctest.h>

#include <cmath>

#include "fitting/clip_posterior.hpp"
#include "fitting/clip_windows.hpp"
#include "fitting/window_problem.hpp"

namespace long_clip_test {

using namespace mcdbn;

namespace {

constexpr Eigen::Index kFrames = 1000;
constexpr double kDepth_m = 4, kLarger = 2, kGain = 1e-2;
const RayNoise kNoise{0.002, 0.004};

/// Two bones beside each other that hang still from a root, seen larger than the prior takes them
/// for: the body is larger or nearer. It walks by, further and further away.
PosteriorClip large_body(bool body_unknown, bool lens_unknown, Eigen::Index frames = kFrames) {
  PosteriorClip clip;
  clip.parents = {-1, 0};
  clip.lengths = {0, 1};
  clip.root = MatrixD::Zero(frames, 3);
  clip.root.col(0) = Eigen::VectorXd::LinSpaced(frames, -1, 1);
  clip.root.col(2) = Eigen::VectorXd::LinSpaced(frames, kDepth_m, 2 * kDepth_m);
  clip.travelled = clip.root;
  clip.planted = MatrixD::Zero(frames, 0);
  clip.turn_deviation_rad = MatrixD::Constant(frames, 2, 0.2);
  clip.frame_time_s = 1.0 / 30;
  clip.body_unknown = body_unknown;
  if (lens_unknown) {
    clip.camera.emplace();
    clip.camera->log_focal = 0.2;
    clip.camera->log_focal_deviation = 0.01;
  }
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Vector3d root = clip.root.row(t).transpose();
    std::vector<SeenJoint> seen;
    for (const double side : {-0.3, 0.3}) {
      const Eigen::Vector3d end = root + kLarger * Eigen::Vector3d(side, 0.7, 0);
      seen.push_back({{{0, {0, 0.4, 0}}, {1, {side, 0.3, 0}}}, end.head<2>() / end.z(), 1});
    }
    clip.seen.push_back(seen);
  }
  return clip;
}

/// Joints of those frames that are not seen: all of them, or the first.
void hide(PosteriorClip& clip, Eigen::Index first, Eigen::Index end, std::size_t joints = 2) {
  for (Eigen::Index t = first; t < end; ++t)
    for (std::size_t joint = 0; joint < joints; ++joint)
      clip.seen[static_cast<std::size_t>(t)][joint].confidence = 0;
}

PosteriorPoint solved(const PosteriorClip& clip, const PosteriorPoint& from,
                      const ClipWindow& window, bool shared_too) {
  WindowProblem problem(clip, kNoise, {}, from, window.first, window.frames);
  problem.solve(shared_too, kGain);
  return problem.solution();
}

/// The sum of a window's depths.
double depth_m(const PosteriorClip& clip, const MatrixD& shift, const ClipWindow& window) {
  return (clip.root.middleRows(window.first, window.frames) + shift).col(2).sum();
}

/// Frames that no other window has are as the window alone has them.
void check_own_frames(const PosteriorPoint& whole, const ClipWindow& window,
                      const PosteriorPoint& alone) {
  CAPTURE(window.first);
  const Eigen::Index at = 2 * kAllFrames.overlap, count = window.frames - 2 * at;
  for (const auto rows : {&PosteriorPoint::turns, &PosteriorPoint::shift})
    DOCTEST_CHECK(
        ((whole.*rows).middleRows(window.first + at, count) - (alone.*rows).middleRows(at, count))
            .cwiseAbs()
            .maxCoeff() < 1e-9);
}

}  // namespace

TEST_CASE("long clip: the other windows take what the middle one finds, and begin at its depth") {
  for (const bool body_unknown : {true, false})
    for (const bool lens_unknown : {true, false}) {
      CAPTURE(body_unknown);
      CAPTURE(lens_unknown);
      const PosteriorClip clip = large_body(body_unknown, lens_unknown);
      const PosteriorPoint zero = PosteriorPoint::zero(clip);
      const std::vector<ClipWindow> windows = windows_of(kFrames);
      DOCTEST_REQUIRE(windows.size() == 4);
      const PosteriorPoint middle = solved(clip, zero, windows[2], true);
      PosteriorPoint from = zero;
      from.log_lengths = middle.log_lengths;
      from.lean = middle.lean;
      from.log_focal = middle.log_focal;
      DOCTEST_REQUIRE((middle.log_lengths.cwiseAbs().maxCoeff() > 0.05) == body_unknown);
      DOCTEST_REQUIRE((middle.log_focal > 0.1) == lens_unknown);
      if (body_unknown || lens_unknown) {
        const double nearer = depth_m(clip, middle.shift, windows[2]) /
                              depth_m(clip, MatrixD::Zero(windows[2].frames, 3), windows[2]);
        DOCTEST_REQUIRE(nearer < 0.95);
        // Every root on the ray that this lens has it on, so much nearer.
        from.shift = (nearer - 1) * clip.root;
        from.shift.leftCols<2>() =
            (nearer / std::exp(middle.log_focal) - 1) * clip.root.leftCols<2>();
      }
      const PosteriorPoint whole =
          map_solution(clip, kNoise, {}, zero, SharedUnknowns::to_be_found, kGain);
      DOCTEST_CHECK(whole.log_lengths == middle.log_lengths);
      DOCTEST_CHECK(whole.log_focal == middle.log_focal);
      DOCTEST_CHECK(whole.lean == middle.lean);
      for (const std::size_t i : {0U, 1U, 3U})
        check_own_frames(whole, windows[i], solved(clip, from, windows[i], false));
    }
}

TEST_CASE("long clip: the window that shows the most joints, of several the one in the middle") {
  const std::vector<ClipWindow> windows = windows_of(kFrames);  // of 280, 310, 310 and 280 frames
  DOCTEST_REQUIRE(windows.size() == 4);
  const PosteriorClip clip = large_body(true, true);
  DOCTEST_CHECK(most_seen(clip, windows) == 2);
  PosteriorClip changed = clip;
  hide(changed, windows[2].end() - 1, windows[2].end(), 1);  // one joint in one frame
  DOCTEST_CHECK(most_seen(changed, windows) == 1);
  changed = clip;
  hide(changed, 0, windows[3].first, 1);
  DOCTEST_CHECK(most_seen(changed, windows) == 3);
  changed = clip;
  hide(changed, windows[1].first, windows[2].end());
  DOCTEST_CHECK(most_seen(changed, windows) == 3);  // it and the first show as many
  hide(changed, 0, kFrames);
  DOCTEST_CHECK(most_seen(changed, windows) == 2);
  for (const Eigen::Index frames : {10, 400})  // one window and two
    DOCTEST_CHECK(most_seen(large_body(true, true, frames), windows_of(frames)) ==
                  windows_of(frames).size() - 1);
}

TEST_CASE("long clip: the window in the middle determines nothing if it shows nobody") {
  const std::vector<ClipWindow> windows = windows_of(kFrames);
  DOCTEST_REQUIRE(windows.size() == 4);
  PosteriorClip clip = large_body(true, true);
  hide(clip, windows[2].first, windows[2].end());
  const PosteriorPoint zero = PosteriorPoint::zero(clip),
                       first = solved(clip, zero, windows[0], true);
  DOCTEST_REQUIRE(first.log_lengths.cwiseAbs().minCoeff() > 1e-6);  // nothing seen would leave 0
  const PosteriorPoint whole =
      map_solution(clip, kNoise, {}, zero, SharedUnknowns::to_be_found, kGain);
  DOCTEST_CHECK(whole.log_lengths == first.log_lengths);
  DOCTEST_CHECK(whole.log_focal == first.log_focal);
}

TEST_CASE("long clip: what was found already stays, and every window is solved with it") {
  const PosteriorClip clip = large_body(true, true);
  PosteriorPoint from = PosteriorPoint::zero(clip);
  from.log_lengths << 0.1, -0.05;
  from.log_focal = 0.3;
  const PosteriorPoint whole =
      map_solution(clip, kNoise, {}, from, SharedUnknowns::as_found, kGain);
  DOCTEST_CHECK(whole.log_lengths == from.log_lengths);
  DOCTEST_CHECK(whole.log_focal == from.log_focal);
  for (const ClipWindow& window : windows_of(kFrames))
    check_own_frames(whole, window, solved(clip, from, window, false));
}

TEST_CASE("long clip: a single window always finds what all frames share") {
  const PosteriorClip clip = large_body(true, true, 300);
  const PosteriorPoint zero = PosteriorPoint::zero(clip);
  const PosteriorPoint found =
      map_solution(clip, kNoise, {}, zero, SharedUnknowns::as_found, kGain);
  DOCTEST_CHECK(found.log_focal == doctest::Approx(0.2).epsilon(0.1));
  DOCTEST_CHECK(found.log_lengths.cwiseAbs().maxCoeff() > 0.05);
}

}  // namespace long_clip_test
