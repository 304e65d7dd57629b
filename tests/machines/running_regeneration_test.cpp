// Answers to a sequence that is still growing are those to the whole of what was shown.

#include "machines/running_regeneration.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "device/every_device.hpp"
#include "machines/random_crbm.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kTrack = 6, kPose = 9, kHidden = 7, kTop = 5, kShared = 4;

/// What the lowest layer of the track is, where tests differ.
struct LowestTrack {
  VisibleKind kind = VisibleKind::gaussian;
  float weights = 1.0F;     ///< W is so many times as large
  bool has_history = true;  ///< else no layer has one, nor has the pose's
};

/// Layers of unequal orders, so that each needs a history of its own length.
Mcdbn network(Device& device, std::size_t look_ahead, const LowestTrack& lowest = {}) {
  const auto order = [&](std::size_t frames) { return lowest.has_history ? frames : 0; };
  CrbmParameters lowest_track = random_layer(kTrack, kHidden, order(1), lowest.kind, 10);
  lowest_track.W *= lowest.weights;
  CrbmParameters lowest_pose = random_layer(kPose, kHidden, order(4), VisibleKind::gaussian, 30);
  lowest_pose.visible_deviation = MatrixF::Constant(1, kPose, 0.5F);
  lowest_pose.visible_deviation(0, 2) = 1.5F;
  lowest_pose.visible_mean = random_matrix(1, kPose, 31);
  Cdbn track, pose;
  track.layers.emplace_back(device, lowest_track);
  track.layers.emplace_back(device, random_layer(kHidden, kTop, order(2), VisibleKind::binary, 20));
  pose.layers.emplace_back(device, lowest_pose);
  pose.layers.emplace_back(device, random_layer(kHidden, kTop, order(1), VisibleKind::binary, 40));
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

TEST_CASE("a running regeneration fills gaps from the settled frames, as regenerate does") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  MatrixF shown = random_matrix(17, kTrack, 7, 1.2F);
  shown(0, 1) = shown(4, 2) = shown(5, 2) = shown(5, 3) = shown(9, 0) = shown(16, 5) = kNan;
  shown.row(8).setConstant(kNan);
  for (const std::size_t look_ahead : {0U, 2U})
    for (const bool has_history : {true, false})
      on_every_device([&](Device& device) {
        CAPTURE(look_ahead);
        CAPTURE(has_history);
        // Weights with which it matters where a gap's mean field begins.
        const Mcdbn net =
            network(device, look_ahead, {.weights = 3.0F, .has_history = has_history});
        RunningRegeneration running(net, 3);
        Eigen::Index settled = 0;
        for (Eigen::Index frames = 1; frames <= shown.rows(); ++frames) {
          CAPTURE(frames);
          const CodedAnswer want = whole_answer(net, shown.topRows(frames), 3);
          const CodedAnswer got = running.answer(shown.middleRows(settled, frames - settled));
          CHECK(largest(got.mean - want.mean.bottomRows(frames - settled)) < kRounding);
          CHECK(largest(got.code - want.code.bottomRows(frames - settled)) < kRounding);
          const Eigen::Index done = frames - settled - static_cast<Eigen::Index>(look_ahead);
          if (done <= 0) continue;
          running.settle(static_cast<std::size_t>(done));
          settled += done;
        }
      });
}

TEST_CASE("behind the end of binary units a look-ahead sees values from 0 to 1") {
  const MatrixF shown = (random_matrix(9, kTrack, 7).array() > 0).cast<float>();
  // Turned about the last row a 0 after a 1 would be −1: from 0 to 1 the last row stays.
  MatrixF longer(11, kTrack);
  longer << shown, shown.bottomRows(1), shown.bottomRows(1);
  on_every_device([&](Device& device) {
    const Mcdbn net = network(device, 2, {.kind = VisibleKind::binary});
    const MatrixF want = whole_answer(net, longer, 3).code.topRows(9);
    CHECK(largest(whole_answer(net, shown, 3).code - want) < kRounding);
    CHECK(largest(RunningRegeneration(net, 3).answer(shown).code - want) < kRounding);
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
