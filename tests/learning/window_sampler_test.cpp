#include "learning/window_sampler.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "base/capture_bound.hpp"

namespace window_sampler_test {

using namespace mcdbn;

namespace {

/// Three clips, the first two of one person: 60 + 40 frames against 20.
SynchronizedClips three_clips() {
  static const std::vector<MatrixF> tracks = {MatrixF::Zero(60, 4), MatrixF::Zero(40, 4),
                                              MatrixF::Zero(20, 4)};
  static const std::vector<MatrixF> poses = {MatrixF::Zero(60, 6), MatrixF::Zero(40, 6),
                                             MatrixF::Zero(20, 6)};
  static const std::vector<std::size_t> people = {0, 0, 1};
  return {{{"track", tracks}, {"pose", poses}}, people};
}

constexpr SequenceWindows kWindows{.count = 50, .frames = 12, .first = 4, .judged_from = 6};

LearningSettings settings_with(double people_power) {
  LearningSettings settings;
  settings.look_ahead = 3;
  settings.fine_tuning.people_power = people_power;
  return settings;
}

/// The share of the judged frames that are the second person's.
double share_of_second(double people_power) {
  const WindowSampler sampler(three_clips(), kWindows, settings_with(people_power));
  double second = 0, all = 0;
  for (std::size_t step = 0; step < 40; ++step) {
    const auto rows = sampler.rows(step);
    for (std::size_t i = 0; i < kWindows.count; ++i, ++all)
      second += rows[i * kWindows.frames + kWindows.judged_from] >= 100;
  }
  return second / all;
}

}  // namespace

TEST_CASE("windows go frame by frame within one clip, 2D the look-ahead later") {
  const WindowSampler sampler(three_clips(), kWindows, settings_with(1.0));
  std::set<std::int32_t> first_judged;
  for (std::size_t step = 0; step < 10; ++step) {
    const auto rows = sampler.rows(step);
    REQUIRE(rows.size() == 2 * kWindows.rows());
    for (std::size_t i = 0; i < kWindows.count; ++i) {
      const std::int32_t* pose = &rows[i * kWindows.frames];
      const std::int32_t* track = pose + kWindows.rows();
      const auto judged = pose[kWindows.judged_from];
      first_judged.insert(judged);
      const std::int32_t begin = judged < 60    ? 0
                                 : judged < 100 ? 60
                                                : 100,
                         end = judged < 60    ? 60
                               : judged < 100 ? 100
                                              : 120;
      for (std::size_t t = 0; t < kWindows.frames; ++t) {
        const auto frame = judged + static_cast<std::int32_t>(t) - 6;
        CHECK(pose[t] == std::clamp(frame, begin, end - 1));
        CHECK(track[t] == std::clamp(frame + 3, begin, end - 1));
      }
      CHECK(judged + 6 <= end);  // every judged frame is one of the clip's
    }
  }
  CHECK(first_judged.count(0) + first_judged.count(60) + first_judged.count(100) == 3);
}

TEST_CASE("people of whom there is little are drawn as often as the power specifies") {
  // 2000 draws: five deviations of the binomial distribution.
  const auto bound = [](double share) { return 5 * std::sqrt(share * (1 - share) / 2000); };
  for (const auto& [power, want] :
       {std::pair{1.0, 20.0 / 120}, {0.0, 0.5}, {0.5, std::sqrt(20.0) / (std::sqrt(20.0) + 10)}}) {
    CAPTURE_BOUND(power);
    CHECK(std::abs(share_of_second(power) - want) < bound(want));
  }
}

}  // namespace window_sampler_test
