#include "formats/frame_numbers.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>
#include <set>

namespace mcdbn {
namespace {

/// The groups of digits of a name, the last one first.
std::vector<std::string> digits_of(const std::string& name) {
  std::vector<std::string> groups;
  bool inside = false;
  for (const char letter : name) {
    const bool digit = std::isdigit(static_cast<unsigned char>(letter)) != 0;
    if (digit && !inside) groups.emplace_back();
    if (digit) groups.back() += letter;
    inside = digit;
  }
  std::ranges::reverse(groups);
  return groups;
}

}  // namespace

std::vector<std::optional<long long>> frame_numbers(const std::vector<std::string>& names) {
  std::vector<std::vector<std::string>> groups;
  std::size_t most = 0;
  for (const std::string& name : names) {
    groups.push_back(digits_of(name));
    most = std::max(most, groups.back().size());
  }
  std::size_t best = 0, best_distinct = 0;
  for (std::size_t group = 0; group < most; ++group) {
    std::set<std::string> distinct;
    for (const auto& of_name : groups)
      if (group < of_name.size()) distinct.insert(of_name[group]);
    if (distinct.size() > best_distinct) {
      best = group;
      best_distinct = distinct.size();
    }
  }
  std::vector<std::optional<long long>> numbers;
  for (const auto& of_name : groups) {
    numbers.emplace_back();
    if (best >= of_name.size()) continue;
    const std::string& digits = of_name[best];
    long long number = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), number).ec == std::errc())
      numbers.back() = number;
  }
  return numbers;
}

std::vector<std::optional<long long>> numbers_of_files(
    const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::filesystem::path& file : files) names.push_back(file.stem().string());
  std::vector<std::optional<long long>> numbers = frame_numbers(names);
  if (std::ranges::none_of(numbers, [](const auto& number) { return number.has_value(); }))
    std::iota(numbers.begin(), numbers.end(), 0LL);
  return numbers;
}

}  // namespace mcdbn
