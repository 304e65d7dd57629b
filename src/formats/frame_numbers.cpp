#include "formats/frame_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <compare>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

#include "formats/csv_text.hpp"

namespace mcdbn {
namespace {

/// A name and its groups of digits, the last one first.
struct SplitName {
  struct Group {
    std::size_t begin, end;
  };

  explicit SplitName(std::string_view whole) : name(whole) {
    const auto is_digit = [&](std::size_t i) {
      return i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])) != 0;
    };
    for (std::size_t i = 0; i < name.size(); ++i) {
      if (!is_digit(i)) continue;
      if (i == 0 || !is_digit(i - 1)) groups.push_back({i, i});
      groups.back().end = i + 1;
    }
    std::ranges::reverse(groups);
  }

  bool has(std::size_t group) const { return group < groups.size(); }
  std::string_view digits(std::size_t group) const {
    return name.substr(groups[group].begin, groups[group].end - groups[group].begin);
  }
  /// What stands between a group and the one before it in the name.
  std::string_view before(std::size_t group) const {
    const std::size_t end = groups[group + 1].end;
    return name.substr(end, groups[group].begin - end);
  }

  std::string_view name;
  std::vector<Group> groups;
};

std::vector<SplitName> split_names(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

std::size_t distinct_digits(const std::vector<SplitName>& names, std::size_t group) {
  std::set<std::string_view> distinct;
  for (const SplitName& name : names)
    if (name.has(group)) distinct.insert(name.digits(group));
  return distinct.size();
}

/// The last one of the groups that differ in the most names.
std::size_t most_different_group(const std::vector<SplitName>& names) {
  std::size_t groups = 0, best = 0, most = 0;
  for (const SplitName& name : names) groups = std::max(groups, name.groups.size());
  for (std::size_t group = 0; group < groups; ++group)
    if (const std::size_t distinct = distinct_digits(names, group); distinct > most) {
      best = group;
      most = distinct;
    }
  return best;
}

std::optional<long long> whole_number(std::string_view digits) {
  long long value = 0;
  const bool fits =
      std::from_chars(digits.data(), digits.data() + digits.size(), value).ec == std::errc();
  return fits ? std::optional(value) : std::nullopt;
}

struct Time {
  long long second;
  double fraction_s;
  // clang-tidy 14 takes the comparison with 0 behind it for one of pointers.
  auto operator<=>(const Time&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// The time whose fraction is this group; after `_` all fractions need the same count of digits.
std::optional<Time> time_in(const SplitName& name, std::size_t group, std::size_t digits) {
  if (!name.has(group + 1)) return {};
  const std::string_view separator = name.before(group);
  if (separator != "." && !(separator == "_" && name.digits(group).size() == digits)) return {};
  const auto second = whole_number(name.digits(group + 1));
  const auto fraction = number(fmt::format("0.{}", name.digits(group)));
  return second && fraction ? std::optional(Time{*second, *fraction}) : std::nullopt;
}

/// The lower one of two.
double median_of(std::vector<double> values) {
  const auto middle = values.begin() + (std::ssize(values) - 1) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Whether times go on from one second into the next. Numbers of a camera and a frame ("cam2.0007")
/// do not: from a camera's last frame to the next one's first it is far.
bool pass_seconds(const std::set<Time>& times) {
  std::vector<double> steps, into_next;
  for (auto at = times.begin(); at != times.end() && std::next(at) != times.end(); ++at) {
    const Time &from = *at, &to = *std::next(at);
    steps.push_back(static_cast<double>(to.second - from.second) + to.fraction_s - from.fraction_s);
    if (to.second != from.second) into_next.push_back(steps.back());
  }
  constexpr double kFar = 10;  // steps
  return !into_next.empty() && median_of(into_next) <= kFar * median_of(steps);
}

/// The times in the names, in the order of these, if the group is the fraction of a second in all
/// names that have it.
/// @return [names], none where a name has no such group; empty: the names hold no times
std::vector<std::optional<Time>> times_in(const std::vector<SplitName>& names, std::size_t group) {
  std::vector<std::optional<Time>> times;
  std::set<Time> distinct;
  const auto first = std::ranges::find_if(names, [&](const auto& name) { return name.has(group); });
  if (first == names.end()) return {};
  for (const SplitName& name : names) {
    times.push_back(time_in(name, group, first->digits(group).size()));
    if (name.has(group) && !times.back()) return {};
    if (times.back()) distinct.insert(*times.back());
  }
  if (!pass_seconds(distinct)) return {};
  return times;
}

/// Which of all times each is, from 0 on.
std::vector<std::optional<long long>> order_of(const std::vector<std::optional<Time>>& times) {
  std::map<Time, long long> order;
  for (const auto& time : times)
    if (time) order.emplace(*time, 0);
  long long next = 0;
  for (auto& [time, number] : order) number = next++;
  std::vector<std::optional<long long>> numbers;
  numbers.reserve(times.size());
  for (const auto& time : times)
    numbers.push_back(time ? std::optional(order.at(*time)) : std::nullopt);
  return numbers;
}

}  // namespace

bool are_times(const std::vector<std::string>& names) {
  const std::vector<SplitName> split = split_names(names);
  return !times_in(split, most_different_group(split)).empty();
}

std::vector<std::optional<long long>> frame_numbers(const std::vector<std::string>& names) {
  const std::vector<SplitName> split = split_names(names);
  const std::size_t group = most_different_group(split);
  if (const auto times = times_in(split, group); !times.empty()) return order_of(times);
  std::vector<std::optional<long long>> numbers;
  numbers.reserve(split.size());
  for (const SplitName& name : split)
    numbers.push_back(name.has(group) ? whole_number(name.digits(group)) : std::nullopt);
  return numbers;
}

std::vector<std::optional<long long>> numbers_of_files(
    const std::vector<std::filesystem::path>& files, std::vector<std::string>* notices) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::filesystem::path& file : files) names.push_back(file.stem().string());
  std::vector<std::optional<long long>> numbers = frame_numbers(names);
  if (std::ranges::none_of(numbers, [](const auto& number) { return number.has_value(); }))
    std::iota(numbers.begin(), numbers.end(), 0LL);
  if (notices != nullptr && are_times(names))
    notices->push_back("its files are named by time: they are taken one after the other");
  return numbers;
}

}  // namespace mcdbn
