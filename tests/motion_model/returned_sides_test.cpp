// Sides of limbs that are seen again, with an energy of the test's own.

#include "motion_model/returned_sides.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "camera/keypoint_track.hpp"
#include "camera/track_columns.hpp"
#include "mcdbn/base/errors.hpp"

namespace returned_sides_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr int kFrames = 400;

/// Left joints at 1 px and right ones at 2, knees and ankles hidden now and then.
Track2d with_gaps(const std::vector<int>& gaps) {
  Track2d track;
  add_sides(track.keypoints, "knee", JointRole::left_knee);
  add_sides(track.keypoints, "ankle", JointRole::left_ankle);
  for (const Keypoint& place : track.keypoints) track.joint_names.push_back(place.name);
  track.fps = 30;
  track.x_px = track.y_px = MatrixD::Ones(kFrames, 4);
  for (const int right : {1, 3}) track.x_px.col(right).setConstant(2);
  track.confidence = MatrixD::Ones(kFrames, 4);
  for (const int gap : gaps) track.confidence.middleRows(gap, 10).setZero();
  return track;
}

void exchange(Track2d& track, int first, int frames) {
  for (int t = first; t < first + frames; ++t) {
    exchange_columns(track, t, 0, 1);
    exchange_columns(track, t, 2, 3);
  }
}

/// Half of one for each frame that shows the left knee where the right one is.
double energy_of(const Track2d& track) {
  return 0.5 * static_cast<double>(
                   (track.confidence.col(0).array() > 0 && track.x_px.col(0).array() == 2).count());
}

}  // namespace

TEST_CASE("returned sides: what is clearly likelier is exchanged, and nothing else") {
  Track2d track = with_gaps({100, 200, 216});
  CHECK(swapped_spells(track, energy_of).empty());
  exchange(track, 210, 6);  // gains 3
  CHECK(described(swapped_spells(track, energy_of)) == "legs swapped in frames 210-215");
  exchange(track, 210, 1);
  CHECK(swapped_spells(track, energy_of).empty());  // gains 2
  exchange(track, 0, 100);
  exchange(track, 226, kFrames - 226);
  CHECK(described(swapped_spells(track, energy_of)) == "legs swapped in frames 0-99, 226-399");
}

TEST_CASE(
    "returned sides: each is asked with two seconds around it, the others as they are by then") {
  Track2d track = with_gaps({100, 300});
  exchange(track, 0, 100);
  std::vector<std::pair<int, double>> asked;
  swapped_spells(track, [&](const Track2d& some) {
    asked.emplace_back(some.frames(), energy_of(some));
    return asked.back().second;
  });
  // Exchanged, then as it is.
  const std::vector<std::pair<int, double>> expected{{160, 0}, {160, 50}, {310, 95},
                                                     {310, 0}, {150, 45}, {150, 0}};
  CHECK(asked == expected);
}

TEST_CASE("returned sides: where too little of a person is seen they stay") {
  Track2d track = with_gaps({100});
  exchange(track, 0, 100);
  CHECK(
      swapped_spells(track, [](const Track2d&) -> double { throw InputError("no fit"); }).empty());
}

}  // namespace returned_sides_test
