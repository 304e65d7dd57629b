#include "mcdbn/camera/side_swaps.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "camera/keypoint_track.hpp"
#include "camera/track_noise.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/resample.hpp"
#include "shared_data.hpp"

namespace side_swaps_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Somebody seen from the side who swings arms and legs, left against right, 300 px tall.
/// @param width of the swings, 1: of a walk
Track2d stepping(int frames = 120, double width = 1) {
  using enum JointRole;
  Track2d track;
  add_sides(track.keypoints, "shoulder", left_shoulder);
  add_sides(track.keypoints, "wrist", left_wrist);
  add_sides(track.keypoints, "hip", left_hip);
  add_sides(track.keypoints, "knee", left_knee);
  add_sides(track.keypoints, "ankle", left_ankle);
  const double y[]{60, 60, 140, 140, 150, 150, 225, 225, 300, 300};
  const double swing[]{2, 2, 60, 60, 4, 4, 35, 35, 70, 70};
  for (const Keypoint& place : track.keypoints) track.joint_names.push_back(place.name);
  track.x_px.resize(frames, 10);
  track.y_px.resize(frames, 10);
  track.confidence = MatrixD::Ones(frames, 10);
  for (int t = 0; t < frames; ++t) {
    for (int k = 0; k < 10; ++k) {
      const double phase = 2 * M_PI * t / 32 + (k % 2 == 0 ? 0 : M_PI);
      track.x_px(t, k) = 500 + 2 * t + width * swing[k] * std::sin(phase);
      track.y_px(t, k) = y[k] + 0.1 * width * swing[k] * std::cos(2 * phase);
    }
  }
  return track;
}

void swap_columns(Track2d& track, const std::string& place, int first, int last) {
  const int left = track.find("left_" + place), right = track.find("right_" + place);
  for (int t = first; t <= last; ++t)
    for (MatrixD* values : {&track.x_px, &track.y_px, &track.confidence})
      std::swap((*values)(t, left), (*values)(t, right));
}

void swap_legs(Track2d& track, int first, int last) {
  for (const char* place : {"hip", "knee", "ankle", "big_toe", "small_toe", "heel"})
    if (track.find(std::string("left_") + place) >= 0) swap_columns(track, place, first, last);
}

bool same(const Track2d& a, const Track2d& b) {
  return a.x_px == b.x_px && a.y_px == b.y_px && a.confidence == b.confidence;
}

}  // namespace

TEST_CASE("side swaps: planted ones are found and put right, frame by frame") {
  const Track2d clean = stepping();
  CHECK(find_side_swaps(clean).empty());
  CHECK(described({}).empty());
  Track2d track = clean;
  swap_legs(track, 20, 28);
  swap_legs(track, 70, 70);
  swap_columns(track, "wrist", 40, 55);
  swap_columns(track, "shoulder", 40, 55);
  const auto swaps = find_side_swaps(track);
  REQUIRE(swaps.size() == 3);
  CHECK(described(swaps) == "legs swapped in frames 20-28, 70; arms in 40-55");
  // By the file's numbers, which may be those of days.
  std::vector<long long> numbers(100);
  std::iota(numbers.begin(), numbers.end(), 3'487'918'200);
  CHECK(described(swaps, numbers) ==
        "legs swapped in frames 3487918220-3487918228, 3487918270; arms in 3487918240-3487918255");
  CHECK(swaps[0].limbs == LimbPair::legs);
  CHECK(swaps[2].limbs == LimbPair::arms);
  exchange_sides(track, swaps);
  CHECK(same(track, clean));
}

TEST_CASE("side swaps: a place that stays on its side stays") {
  const Track2d clean = stepping();
  Track2d track = clean;
  swap_columns(track, "ankle", 20, 27);  // knees and hips do not
  const auto swaps = find_side_swaps(track);
  REQUIRE(swaps.size() == 1);
  CHECK(std::ranges::count(swaps[0].left, track.find("left_ankle")) == 1);
  CHECK(std::ranges::count(swaps[0].left, track.find("left_knee")) == 0);
  exchange_sides(track, swaps);
  CHECK(same(track, clean));
}

TEST_CASE("side swaps: seen through a gap, and the sides held for longer are right") {
  Track2d track = stepping();
  swap_legs(track, 20, 40);
  for (const char* place : {"left_ankle", "right_knee"}) {
    track.confidence.col(track.find(place)).segment(30, 5).setZero();
    track.x_px.col(track.find(place))
        .segment(30, 5)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  CHECK(described(find_side_swaps(track)) == "legs swapped in frames 20-40");
  Track2d mostly = stepping();
  swap_legs(mostly, 0, 90);
  CHECK(described(find_side_swaps(mostly)) == "legs swapped in frames 91-119");
}

TEST_CASE("side swaps: a joint that is astray for a frame, however far, makes no swap") {
  for (const char* place : {"left_ankle", "right_wrist"})
    for (const double away_px : {150.0, 300.0, -1000.0}) {
      CAPTURE(place);
      CAPTURE(away_px);
      Track2d track = stepping();
      track.x_px(30, track.find(place)) += away_px;
      CHECK(find_side_swaps(track).empty());
    }
}

TEST_CASE("side swaps: small jumps, long gaps and a track without keypoints are left alone") {
  // Legs so close together that they jump by less than a quarter of the body's height in all.
  Track2d close = stepping(120, 0.05);
  swap_legs(close, 20, 31);
  CHECK(find_side_swaps(close).empty());
  Track2d track = stepping();
  swap_legs(track, 20, 31);
  // Seen in two frames of three only: no velocities without bridging.
  for (int t = 0; t < track.frames(); t += 3) track.confidence.row(t).setZero();
  CHECK(described(find_side_swaps(track)).starts_with("legs swapped in frames "));
  // Seen in one frame of nine: gaps of more than 0.2 s are not bridged.
  for (int t = 0; t < track.frames(); ++t)
    if (t % 9 != 1) track.confidence.row(t).setZero();
  CHECK(find_side_swaps(track).empty());
  track.keypoints.clear();
  CHECK(find_side_swaps(track).empty());
  CHECK(find_side_swaps(Track2d{}).empty());
  CHECK(find_side_swaps(stepping(2)).empty());
}

TEST_CASE("side swaps: in recorded walks and runs, seen from all around by a noisy detector") {
  int found = 0, planted = 0, wrong = 0, views = 0, touched = 0;
  for (const char* file : {"cmu/walk/02_01.bvh", "cmu/walk/35_01.bvh"}) {
    if (!have_shared_data(file, "side swaps in recorded motion")) return;
    Motion motion = read_bvh(shared_data() / file);
    motion.channels = MatrixD(motion.channels.bottomRows(motion.frames() - 1));  // the T-pose
    motion = resample(motion, 30);
    for (const double azimuth : {0.0, 45.0, 90.0, 200.0}) {
      CameraPlacement placement;
      placement.azimuth_deg = azimuth;
      Track2d track = keypoint_track(motion, place_camera(motion, placement), body_25_keypoints());
      add_pixel_noise(track, 2, 5 + static_cast<std::uint64_t>(azimuth));
      ++views;
      touched += !find_side_swaps(track).empty();
      const int first = track.frames() / 3, last = first + track.frames() / 4;
      swap_legs(track, first, last);
      planted += last - first + 1;
      for (const SideSwap& swap : find_side_swaps(track)) {
        for (int t = swap.first_frame; t <= swap.last_frame; ++t)
          ++(swap.limbs == LimbPair::legs && t >= first && t <= last ? found : wrong);
      }
    }
  }
  CHECK(touched == 0);
  CHECK(found >= 0.97 * planted);
  CHECK(wrong <= 0.03 * planted);
  CHECK(views == 8);
}

}  // namespace side_swaps_test
