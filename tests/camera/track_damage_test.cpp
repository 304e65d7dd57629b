// Every kind of damage to a track, alone.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "camera/track_noise.hpp"
#include "mcdbn/camera/camera.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;

namespace {

Track2d track_at(double fps) {
  const Motion motion = test::swinging(test::small_body(), 120, fps);
  return project_motion(motion, place_camera(motion, {}));
}

Eigen::Index missing(const Track2d& track) {
  return (track.confidence.array() == 0).count();
}

}  // namespace

TEST_CASE("damage: each kind does its own, as much as asked for") {
  const Skeleton body = test::small_body();
  const Track2d whole = track_at(60);
  const auto damaged = [&](const TrackDamage& damage, std::uint64_t seed = 1) {
    Track2d track = whole;
    damage_track(track, body, damage, seed);
    return track;
  };
  const Track2d noisy = damaged({3, 0, 0});
  CHECK(missing(noisy) == 0);
  const MatrixD off_x = noisy.x_px - whole.x_px, off_y = noisy.y_px - whole.y_px;
  const auto count = static_cast<double>(off_x.size());
  // 1680 draws each: five deviations of a deviation and of a correlation.
  CHECK(std::abs(off_x.norm() / std::sqrt(count) - 3) < 5 * 3 / std::sqrt(2 * count));
  CHECK(std::abs(off_y.norm() / std::sqrt(count) - 3) < 5 * 3 / std::sqrt(2 * count));
  CHECK(std::abs(off_x.cwiseProduct(off_y).sum()) / (9 * count) < 5 / std::sqrt(count));

  const Track2d sparse = damaged({0, 0.25, 0});
  CHECK(std::abs(static_cast<double>(missing(sparse)) - 0.25 * count) <
        5 * std::sqrt(count * 0.25 * 0.75));
  // Half a second of an arm, at sixty frames a second.
  const Track2d hidden = damaged({0, 0, 0.5});
  CHECK(missing(hidden) == 30);

  const auto differs = [](const Track2d& a, const Track2d& b) { return a.x_px != b.x_px; };
  CHECK(differs(damaged({3, 0, 0}, 1), damaged({3, 0, 0}, std::uint64_t{1} << 32U)));
  CHECK(differs(damaged({3, 0, 0}, 1), damaged({3, 0, 0}, 1 + (std::uint64_t{1} << 32U))));
  // Not the seed itself: what reads the track may draw with that one.
  Track2d plain = whole;
  add_pixel_noise(plain, 3, 1);
  CHECK(differs(plain, noisy));
}

TEST_CASE("damage: a limb is hidden for 0.3 to 1.5 seconds, about every other second") {
  const Skeleton body = test::small_body();
  const auto any_hidden = [&](int frames, double fps, std::uint64_t seed) {
    Track2d track = track_at(fps);
    for (MatrixD* values : {&track.x_px, &track.y_px, &track.confidence})
      *values = MatrixD::Ones(frames, track.joint_count());
    hide_limbs(track, body, seed);
    std::vector<bool> hidden;
    for (int t = 0; t < frames; ++t) hidden.push_back((track.confidence.row(t).array() == 0).any());
    return hidden;
  };
  // Once in less than three seconds: where it touches no end, its whole time is seen.
  double shortest_s = 9, longest_s = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const std::vector<bool> hidden = any_hidden(290, 100, seed);
    const auto count = std::count(hidden.begin(), hidden.end(), true);
    if (count == 0 || hidden.front() || hidden.back()) continue;
    shortest_s = std::min(shortest_s, static_cast<double>(count) / 100);
    longest_s = std::max(longest_s, static_cast<double>(count) / 100);
  }
  CHECK(shortest_s >= 0.29);
  CHECK(shortest_s < 0.6);
  CHECK(longest_s <= 1.51);
  CHECK(longest_s > 1.2);
  // Ten times in twenty seconds, 0.9 seconds each, some of them at once.
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const std::vector<bool> hidden = any_hidden(1000, 50, seed);
    const auto seconds = static_cast<double>(std::count(hidden.begin(), hidden.end(), true)) / 50;
    CHECK(seconds > 3.5);
    CHECK(seconds < 11);
  }
}
