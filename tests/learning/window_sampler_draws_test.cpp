#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/capture_bound.hpp"
#include "learning/window_sampler.hpp"
#include "reference/fine_tuning_reference.hpp"

namespace window_sampler_draws_test {

using namespace mcdbn;

namespace {

constexpr SequenceWindows kWindows{.count = 40, .frames = 9, .first = 2, .judged_from = 4};
constexpr Eigen::Index kJudged = 5;

struct Clips {
  std::vector<Eigen::Index> frames;
  std::vector<std::size_t> people;
};
/// The third is as long as a window's judged frames, the last one shorter.
const Clips kClips{{30, 12, 5, 47, 3}, {4, 0, 4, 2, 0}};

LearningSettings settings(double people_power, std::uint64_t seed = 3) {
  LearningSettings config;
  config.seed = seed;
  config.look_ahead = 6;
  config.fine_tuning.people_power = people_power;
  return config;
}

std::vector<std::int32_t> rows_of(const Clips& clips, const LearningSettings& config,
                                  std::size_t step) {
  std::vector<MatrixF> frames;
  for (const Eigen::Index count : clips.frames) frames.push_back(MatrixF::Zero(count, 1));
  return WindowSampler({{{"one", frames}, {"other", frames}}, clips.people}, kWindows, config)
      .rows(step);
}

/// The same by the reference: clips whose only value is the number of their row.
std::vector<std::int32_t> rows_in_reference(const Clips& clips, const LearningSettings& config,
                                            std::size_t step) {
  reference::FineTuningData data;
  data.people = clips.people;
  double next = 0;
  for (const Eigen::Index frames : clips.frames) {
    MatrixD numbers(frames, 1);
    for (Eigen::Index t = 0; t < frames; ++t) numbers(t, 0) = next++;
    data.tracks.push_back(numbers);
    data.poses.push_back(numbers);
  }
  reference::FineTuningSettings same;
  same.seed = config.seed;
  same.look_ahead = config.look_ahead;
  same.people_power = config.fine_tuning.people_power;
  const reference::DrawnWindows drawn = reference::drawn_windows(
      data,
      {static_cast<Eigen::Index>(kWindows.count), static_cast<Eigen::Index>(kWindows.frames),
       static_cast<Eigen::Index>(kWindows.first), static_cast<Eigen::Index>(kWindows.judged_from)},
      same, step);
  std::vector<std::int32_t> rows;
  for (const MatrixD* block : {&drawn.pose, &drawn.track})
    for (Eigen::Index i = 0; i < block->rows(); ++i)
      rows.push_back(static_cast<std::int32_t>((*block)(i, 0)));
  return rows;
}

/// First judged rows of the windows of many mini-batches.
std::vector<std::int32_t> first_judged(const Clips& clips, const LearningSettings& config) {
  std::vector<std::int32_t> starts;
  for (std::size_t step = 0; step < 100; ++step) {
    const auto rows = rows_of(clips, config, step);
    for (std::size_t i = 0; i < kWindows.count; ++i)
      starts.push_back(rows[i * kWindows.frames + kWindows.judged_from]);
  }
  return starts;
}

}  // namespace

TEST_CASE("windows are those that the reference draws, row by row") {
  for (const double power : {0.0, 0.4, 1.0})
    for (const std::size_t step : {0U, 1U, 70000U}) {
      CAPTURE(power);
      CAPTURE(step);
      CHECK(rows_of(kClips, settings(power), step) ==
            rows_in_reference(kClips, settings(power), step));
    }
  // Where people are unknown all are one person.
  const Clips unknown{kClips.frames, {}};
  CHECK(rows_of(unknown, settings(0.4), 2) == rows_in_reference(unknown, settings(0.4), 2));
}

TEST_CASE("windows are others in every mini-batch, for every seed and at every place of a batch") {
  const auto first = rows_of(kClips, settings(0.5), 0);
  CHECK(first == rows_of(kClips, settings(0.5), 0));
  CHECK(first != rows_of(kClips, settings(0.5), 1));
  CHECK(first != rows_of(kClips, settings(0.5, 4), 0));
  std::set<std::int32_t> starts;
  for (std::size_t i = 0; i < kWindows.count; ++i)
    starts.insert(first[i * kWindows.frames + kWindows.judged_from]);
  CHECK(starts.size() > 10);
}

TEST_CASE("a tenth of the windows starts at its clip's first frame, the others anywhere in it") {
  // A single clip: every one of its 43 starts but the first is drawn as often as any other.
  const Clips one{{47}, {0}};
  const auto starts = first_judged(one, settings(1.0));
  std::map<std::int32_t, double> count;
  for (const std::int32_t start : starts) ++count[start];
  const auto all = static_cast<double>(starts.size()), places = 47.0 - kJudged + 1.0;
  const auto near = [&](double got, double share) {
    return std::abs(got - share * all) < 5 * std::sqrt(all * share * (1 - share));
  };
  CHECK(count.size() == static_cast<std::size_t>(places));
  CHECK(near(count[0], 0.1 + 0.9 / places));
  for (const auto& [start, times] : count) {
    CAPTURE_BOUND(start);
    if (start > 0) CHECK(near(times, 0.9 / places));
  }
  CHECK(count.rbegin()->first == 47 - kJudged);
}

TEST_CASE("clips of one person are drawn as their frames, whatever the power") {
  const Clips clips{{60, 20, 40}, {0, 0, 1}};
  for (const double power : {0.0, 0.5}) {
    double first = 0, second = 0;
    for (const std::int32_t start : first_judged(clips, settings(power))) {
      first += start < 60;
      second += start >= 60 && start < 80;
    }
    const double both = first + second;
    CHECK(std::abs(first - 0.75 * both) < 5 * std::sqrt(both * 0.75 * 0.25));
  }
}

}  // namespace window_sampler_draws_test
