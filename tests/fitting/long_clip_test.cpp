// A clip of several windows: the middle one tells what they have in common, and where the others
// begin. CHECK is glog's here, as in terms_test.cpp.

#include <doctest/doctest.h>

#include <algorithm>

#include "fitting/clip_posterior.hpp"
#include "fitting/clip_windows.hpp"
#include "fitting/window_problem.hpp"

namespace long_clip_test {

using namespace mcdbn;

namespace {

constexpr Eigen::Index kFrames = 1000;
constexpr double kDepth_m = 4, kLarger = 1.6, kGain = 1e-2;
const RayNoise kNoise{0.002, 0.004};

/// Two bones beside each other that hang still from a root, seen larger than the prior takes them
/// for: the body is larger or nearer. It walks by, further and further away.
PosteriorClip large_body(bool body_unknown) {
  PosteriorClip clip;
  clip.parents = {-1, 0};
  clip.lengths = {0, 1};
  clip.root = MatrixD::Zero(kFrames, 3);
  clip.root.col(0) = Eigen::VectorXd::LinSpaced(kFrames, -1, 1);
  clip.root.col(2) = Eigen::VectorXd::LinSpaced(kFrames, kDepth_m, 2 * kDepth_m);
  clip.travelled = clip.root;
  clip.planted = MatrixD::Zero(kFrames, 0);
  clip.turn_deviation_rad = MatrixD::Constant(kFrames, 2, 0.2);
  clip.frame_time_s = 1.0 / 30;
  clip.body_unknown = body_unknown;
  for (Eigen::Index t = 0; t < kFrames; ++t) {
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

}  // namespace

TEST_CASE("long clip: the other windows have the body of the middle one, and begin at its depth") {
  for (const bool body_unknown : {true, false}) {
    CAPTURE(body_unknown);
    const PosteriorClip clip = large_body(body_unknown);
    const PosteriorPoint zero = PosteriorPoint::zero(clip);
    const std::vector<ClipWindow> windows = windows_of(kFrames);
    REQUIRE(windows.size() == 4);
    const PosteriorPoint middle = solved(clip, zero, windows[2], true);
    PosteriorPoint from = zero;
    from.log_lengths = middle.log_lengths;
    if (body_unknown) {
      REQUIRE(middle.log_lengths.cwiseAbs().maxCoeff() > 0.05);
      const double nearer = depth_m(clip, middle.shift, windows[2]) /
                            depth_m(clip, MatrixD::Zero(windows[2].frames, 3), windows[2]);
      REQUIRE(nearer < 0.9);
      from.shift = (nearer - 1) * clip.root;  // every root on its own ray, so much nearer
    }
    const PosteriorPoint whole = most_likely(clip, kNoise, {}, zero, kGain);
    DOCTEST_CHECK(whole.log_lengths == middle.log_lengths);
    for (const std::size_t i : {0U, 1U, 3U}) {
      CAPTURE(i);
      const PosteriorPoint alone = solved(clip, from, windows[i], false);
      // Frames that no other window has.
      const Eigen::Index at = 2 * kAllFrames.overlap, own = windows[i].first + at;
      const Eigen::Index count = std::min(kAllFrames.frames, windows[i].frames - at) - at;
      DOCTEST_CHECK((whole.shift.middleRows(own, count) - alone.shift.middleRows(at, count))
                        .cwiseAbs()
                        .maxCoeff() < 1e-9);
      DOCTEST_CHECK((whole.turns.middleRows(own, count) - alone.turns.middleRows(at, count))
                        .cwiseAbs()
                        .maxCoeff() < 1e-9);
    }
  }
}

}  // namespace long_clip_test
