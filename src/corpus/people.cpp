#include "corpus/people.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>

#include "motion/body_root.hpp"

namespace mcdbn {
namespace {

/// The group in brackets of the first pattern that matches the whole file name.
std::optional<std::string> known_by_name(const std::filesystem::path& file, const std::regex& first,
                                         const std::regex& second) {
  const std::string name = file.stem().string();
  std::smatch found;
  if (!std::regex_match(name, found, first) && !std::regex_match(name, found, second)) return {};
  return found[1].str();
}

}  // namespace

std::size_t PeopleCount::number_of(const Skeleton& skeleton, const std::string& given) {
  Person person{given, {}};
  if (given.empty())
    for (int j = body_root(skeleton) + 1; j < skeleton.joint_count(); ++j)
      person.bones.push_back(skeleton.joints[static_cast<std::size_t>(j)].offset.norm());
  const auto same = [&](const Person& other) {
    return other.given == given &&
           std::equal(person.bones.begin(), person.bones.end(), other.bones.begin(),
                      other.bones.end(),
                      [](double x, double y) { return std::abs(x - y) <= 1e-3 * std::abs(x); });
  };
  const auto found = std::find_if(people_.begin(), people_.end(), same);
  const auto number = static_cast<std::size_t>(found - people_.begin());
  if (found == people_.end()) people_.push_back(std::move(person));
  return number;
}

std::string person_of(const std::filesystem::path& file) {
  static const std::regex cmu("(\\d+)_\\d+.*"), synthesized(".*_(s\\d+)_\\d+");
  return known_by_name(file, cmu, synthesized).value_or("");
}

std::string action_of(const std::filesystem::path& file) {
  static const std::regex bandai("dataset-\\d+_(.+)_[^_]+_\\d+"), synthesized("(.+)_s\\d+_\\d+");
  return known_by_name(file, bandai, synthesized)
      .value_or(std::filesystem::absolute(file).parent_path().filename().string());
}

}  // namespace mcdbn
