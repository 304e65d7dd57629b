// Answers to a sequence that is still growing are those to the whole of what was shown.

#include "machines/running_regeneration.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "device/every_device.hpp"
#include "machines/random_crbm.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kTrack = 6, kPose = 9, kHidden = 7, kTop = 5, kShared = 4;

/// Layers of unequal orders, so that each needs a history of its own length.
Mcdbn network(Device& device, std::size_t look_ahead) {
  CrbmParameters lowest_pose = random_layer(kPose, kHidden, 4, VisibleKind::gaussian, 30);
  lowest_pose.visible_deviation = MatrixF::Constant(1, kPose, 0.5F);
  lowest_pose.visible_deviation(0, 2) = 1.5F;
  Cdbn track, pose;
  track.layers.emplace_back(device, random_layer(kTrack, kHidden, 1, VisibleKind::gaussian, 10));
  track.layers.emplace_back(device, random_layer(kHidden, kTop, 2, VisibleKind::binary, 20));
  pose.layers.emplace_back(device, lowest_pose);
  pose.layers.emplace_back(device, random_layer(kHidden, kTop, 1, VisibleKind::binary, 40));
  const MrbmParameters mrbm = mrbm_of(
      {random_matrix(kTop, kShared, 50, 2.0F), random_matrix(kTop, kShared, 51, 2.0F)},
      {random_matrix(1, kTop, 52), random_matrix(1, kTop, 53)}, random_matrix(1, kShared, 54));
  return {{std::move(track), std::move(pose)}, Mrbm(device, mrbm), look_ahead, 3};
}

CodedAnswer whole_answer(const Mcdbn& network, const MatrixF& shown, std::size_t run_in) {
  RegenerationOptions options;
  options.run_in = run_in;
  return coded_answers(network, {shown}, options).front();
}

double largest(const MatrixF& difference) {
  return difference.cwiseAbs().maxCoeff();
}

/// Other launches sum in other orders: some units of the last place of numbers up to 10.
constexpr double kRounding = 1e-4;

}  // namespace

TEST_CASE("small: a running regeneration answers as regenerate does for all that was shown") {
  for (const std::size_t look_ahead : {0U, 2U})
    for (const std::size_t run_in : {0U, 5U})
      on_every_device([&](Device& device) {
        CAPTURE(look_ahead);
        CAPTURE(run_in);
        const Mcdbn net = network(device, look_ahead);
        const MatrixF shown = random_matrix(17, kTrack, 7, 1.2F);
        RunningRegeneration running(net, run_in);
        Eigen::Index settled = 0;
        for (Eigen::Index frames = 1; frames <= shown.rows(); ++frames) {
          CAPTURE(frames);
          const CodedAnswer want = whole_answer(net, shown.topRows(frames), run_in);
          const CodedAnswer got = running.answer(shown.middleRows(settled, frames - settled));
          REQUIRE(got.mean.rows() == frames - settled);
          CHECK(largest(got.mean - want.mean.bottomRows(frames - settled)) < kRounding);
          CHECK(largest(got.code - want.code.bottomRows(frames - settled)) < kRounding);
          // What waited for the look-ahead does not change any more. Once, several at a time.
          const Eigen::Index done = frames - settled - static_cast<Eigen::Index>(look_ahead);
          if (done <= 0 || frames == 5 || frames == 6) continue;
          running.settle(static_cast<std::size_t>(done));
          settled += done;
        }
      });
}

TEST_CASE("small: open frames may be shown otherwise, settled ones are history") {
  on_every_device([&](Device& device) {
    const Mcdbn net = network(device, 1);
    const MatrixF shown = random_matrix(9, kTrack, 7, 1.2F);
    RunningRegeneration running(net, 3);
    MatrixF wrong = shown;
    wrong.row(6).setConstant(2);
    (void)running.answer(wrong.topRows(7));
    running.settle(5);
    const CodedAnswer got = running.answer(shown.bottomRows(4));
    // Frame 4, the last that has settled, saw frame 5 ahead, which was right then.
    const CodedAnswer want = whole_answer(net, shown, 3);
    CHECK(largest(got.mean - want.mean.bottomRows(4)) < kRounding);
  });
}

TEST_CASE("a running regeneration: gaps are the mean, and what does not fit is refused") {
  on_every_device([&](Device& device) {
    Mcdbn net = network(device, 1);
    net.fills_gaps = false;
    MatrixF shown = random_matrix(6, kTrack, 7, 1.2F);
    shown(5, 2) = std::numeric_limits<float>::quiet_NaN();
    RunningRegeneration running(net, 3);
    CHECK(largest(running.answer(shown).mean - whole_answer(net, shown, 3).mean) < kRounding);
    CHECK_THROWS_AS(running.settle(7), ShapeError);
    CHECK_THROWS_AS(running.answer(MatrixF::Zero(0, kTrack)), ShapeError);
    CHECK_THROWS_AS(running.answer(MatrixF::Zero(2, kTrack + 1)), ShapeError);
  });
}
