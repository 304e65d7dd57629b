#include "formats/image_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "base/shown.hpp"
#include "formats/frame_numbers.hpp"

namespace mcdbn {
namespace {

/// Without ".jpg": the last part, if there is a letter in it.
std::string without_ending(const std::string& name) {
  const auto dot = name.rfind('.');
  if (dot == std::string::npos) return name;
  const bool ending = std::any_of(name.begin() + static_cast<std::ptrdiff_t>(dot), name.end(),
                                  [](unsigned char c) { return std::isalpha(c) != 0; });
  return ending ? name.substr(0, dot) : name;
}

std::vector<std::string> names_under(const std::vector<JsonPlace>& entries,
                                     const std::string& key) {
  std::set<std::string> names;
  for (const JsonPlace& entry : entries)
    if (entry.has(key.c_str()) && entry[key].value().is_string()) names.insert(entry[key].text());
  return {names.begin(), names.end()};
}

}  // namespace

ImageNumbers::ImageNumbers(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  plain.reserve(names.size());
  for (const std::string& name : names) plain.push_back(without_ending(name));
  const auto numbers = frame_numbers(plain);
  for (std::size_t i = 0; i < names.size(); ++i) numbers_[names[i]] = numbers[i];
}

ImageNumbers::ImageNumbers(const std::vector<JsonPlace>& entries, const std::string& key)
    : ImageNumbers(names_under(entries, key)) {}

long long ImageNumbers::of(const JsonPlace& place, const std::string& name) const {
  const auto number = numbers_.find(name);
  if (number == numbers_.end() || !number->second)
    place.fail(fmt::format("no number of a frame in {}", shown(name)));
  return *number->second;
}

long long ImageNumbers::of(const JsonPlace& id) const {
  return id.value().is_string() ? of(id, id.text()) : id.whole_number();
}

}  // namespace mcdbn
