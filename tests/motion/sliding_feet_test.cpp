#include "motion/sliding_feet.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mcdbn/base/errors.hpp"
#include "motion/synthetic_motion.hpp"

namespace sliding_feet_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr int kFrames = 60;
constexpr double kFps = 30, kUnitsPerMetre = 100;

/// Legs that swing against each other, twice in the clip, while the body goes on.
Motion walking(double most_deg, double speed_m_s) {
  Motion motion{small_body(), 1 / kFps, {}};
  const Skeleton& body = motion.skeleton;
  motion.channels = MatrixD::Zero(kFrames, body.channel_count());
  for (const auto& [leg, side] : {std::pair{"LLeg", 1.0}, std::pair{"RLeg", -1.0}}) {
    const int joint = body.find(leg);
    const auto& channels = body.joints[static_cast<std::size_t>(joint)].channels;
    const auto about_x = std::ranges::find(channels, Channel::x_rotation) - channels.begin();
    for (int t = 0; t < kFrames; ++t)
      motion.channels(t, body.first_channel(joint) + about_x) =
          side * most_deg * std::sin(2 * std::numbers::pi * t / kFps);
  }
  for (int t = 0; t < kFrames; ++t)
    motion.channels(t, 2) = speed_m_s * kUnitsPerMetre * t / kFps;  // root z
  return motion;
}

const std::vector<bool> kAll(kFrames, true);

}  // namespace

TEST_CASE("sliding feet: of one who walks on the spot all slide, of one who gets on one stays") {
  // They slide but where they turn round; of one who gets on one foot is slower than the hips.
  CHECK(share_of_sliding(walking(30, 0), kAll) > 0.8);
  CHECK(share_of_sliding(walking(30, 1.6), kAll) == 0);
  CHECK(share_of_sliding(walking(0, 1.6), kAll) == 0);
  CHECK(share_of_sliding(walking(0, 0), kAll) == 0);
  // At most 0.37 m/s: feet that are planted are as fast.
  CHECK(share_of_sliding(walking(4, 0), kAll) == 0);
}

TEST_CASE("sliding feet: only the frames asked for, the same in every unit") {
  Motion motion = walking(30, 0);
  motion.channels.bottomRows(kFrames / 2).rowwise() = motion.channels.row(kFrames / 2 - 1).eval();
  std::vector<bool> first(kFrames), last(kFrames), none(kFrames);
  for (int t = 0; t < kFrames; ++t) (t < kFrames / 2 ? first : last)[t] = true;
  CHECK(share_of_sliding(motion, first) > 0.8);
  CHECK(share_of_sliding(motion, last) == 0);
  CHECK(share_of_sliding(motion, none) == 0);
  Motion metres = motion;
  for (Joint& joint : metres.skeleton.joints) joint.offset /= kUnitsPerMetre;
  CHECK(share_of_sliding(metres, kAll) == share_of_sliding(motion, kAll));
  CHECK_THROWS_AS(share_of_sliding(motion, {true}), ShapeError);
}

TEST_CASE("sliding feet: a body without feet has none that slide") {
  Motion motion = walking(30, 0);
  for (const char* foot : {"LFoot", "RFoot"})
    motion.skeleton.joints[static_cast<std::size_t>(motion.skeleton.find(foot))].name = "End";
  CHECK(share_of_sliding(motion, kAll) == 0);
}

}  // namespace sliding_feet_test
