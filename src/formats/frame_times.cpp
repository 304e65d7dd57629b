#include "formats/frame_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "base/numbers.hpp"
#include "base/shown.hpp"
#include "base/upper_median.hpp"
#include "formats/field_names.hpp"

namespace mcdbn {
namespace {

constexpr double kLatest = 1e19;          // nanoseconds since 1970 are 2e18
constexpr double kMostSteps = 1e9;        // in a row without a frame
constexpr double kLongerThanUsual = 1.5;  // a frame that is left out makes 2

/// The mean of the steps that are no gaps. The median alone would be as coarse as the times: 33 ms
/// for 33.3.
double usual_step(const std::vector<double>& steps) {
  const double longest = kLongerThanUsual * upper_median(steps);
  double sum = 0;
  int count = 0;
  for (const double step : steps)
    if (step <= longest) {
      sum += step;
      ++count;
    }
  return sum / count;
}

std::map<double, long long> frames_of(const std::set<double>& times) {
  std::vector<double> steps;
  for (auto at = times.begin(); std::next(at) != times.end(); ++at)
    steps.push_back(*std::next(at) - *at);
  std::map<double, long long> frames{{*times.begin(), 0}};
  if (steps.empty()) return frames;
  const double usual = usual_step(steps);
  long long frame = 0;
  for (auto at = std::next(times.begin()); at != times.end(); ++at) {
    const double step = *at - *std::prev(at);
    frame += std::max(1LL, std::llround(std::min(step / usual, kMostSteps)));
    frames.emplace(*at, frame);
  }
  return frames;
}

/// The number under the first key whose name is such.
template <typename IsName>
std::optional<std::string> key_of_number(const JsonPlace& entry, const IsName& is_name) {
  if (!entry.is_object()) return {};
  for (const auto& [key, value] : entry.value().items())
    if (value.is_number() && is_name(key)) return key;
  return {};
}

std::optional<long long> frame_number_in(const JsonPlace& entry) {
  const auto key = key_of_number(entry, is_frame_name);
  return key ? std::optional(entry[*key].whole_number()) : std::nullopt;
}

std::optional<std::string> time_key(const JsonPlace& entry) {
  return key_of_number(entry, [](std::string_view key) { return time_name(key).has_value(); });
}

}  // namespace

std::vector<long long> frames_by_times(const std::vector<double>& times) {
  const auto is_time = [](double time) { return std::abs(time) < kLatest; };
  if (times.empty() || !std::ranges::all_of(times, is_time)) return {};
  const auto frame_at = frames_of(std::set<double>(times.begin(), times.end()));
  std::vector<long long> frames;
  frames.reserve(times.size());
  for (const double time : times) frames.push_back(frame_at.at(time));
  return frames;
}

bool do_rise(const std::vector<double>& times, const std::vector<std::string>& people) {
  std::map<std::string_view, double> latest;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string_view person = people.empty() ? std::string_view() : people[i];
    const auto [last, is_first] = latest.try_emplace(person, times[i]);
    if (std::isnan(times[i]) || (!is_first && times[i] <= last->second)) return false;
    last->second = times[i];
  }
  return true;
}

void take_times(SeenPeople& people, std::string_view name, const std::vector<long long>& numbers,
                const std::vector<double>& times) {
  std::map<long long, double> of_frames;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (std::isfinite(times[i])) of_frames.emplace(numbers[i], times[i]);
  if (of_frames.size() < 2) return;
  std::vector<double> steps;
  for (auto at = of_frames.begin(); std::next(at) != of_frames.end(); ++at)
    steps.push_back(std::next(at)->second - at->second);
  if (!std::ranges::all_of(steps, [](double step) { return step > 0 && step < kLatest; })) {
    people.notices.push_back(fmt::format(
        "its times, {}, do not rise from frame to frame: they are not used", shown(name)));
    return;
  }
  const auto named = time_name(name);
  double unit_s = 1;
  if (named && named->unit_s)
    unit_s = *named->unit_s;
  else
    while (unit_s * upper_median(steps) > 1 && unit_s > 1e-9) unit_s /= 1000;
  for (const auto& [frame, time] : of_frames) people.times_s[frame] = unit_s * time;
}

bool gives_frame(const JsonPlace& entry) {
  return frame_number_in(entry) || time_key(entry);
}

std::vector<long long> numbers_of_frames(const JsonPlace& list, SeenPeople& people) {
  const std::vector<JsonPlace> entries = list.list();
  std::vector<std::optional<long long>> given;
  std::optional<std::string> key;  // the times'
  for (const JsonPlace& entry : entries) {
    given.push_back(frame_number_in(entry));
    if (!key) key = time_key(entry);
  }
  std::vector<double> times;
  times.reserve(entries.size());
  for (const JsonPlace& entry : entries)
    times.push_back(key && time_key(entry) == key ? entry[*key].number() : kNan);
  std::vector<long long> numbers;
  if (std::ranges::none_of(given, [](const auto& number) { return number.has_value(); }) &&
      do_rise(times))
    numbers = frames_by_times(times);
  if (numbers.empty()) {
    long long next = 0;
    for (const auto& number : given) {
      numbers.push_back(number.value_or(next));
      next = numbers.back() + 1;
    }
  }
  if (key) take_times(people, *key, numbers, times);
  return numbers;
}

}  // namespace mcdbn
