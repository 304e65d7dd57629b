#include "corpus/people.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

namespace mcdbn {

std::size_t PeopleCount::number_of(const Skeleton& skeleton, const std::string& said) {
  Person person{said, {}};
  if (said.empty())
    for (const Joint& joint : skeleton.joints) person.bones.push_back(joint.offset.norm());
  const auto same = [&](const Person& other) {
    return other.said == said &&
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
  const std::string name = file.stem().string();
  std::smatch found;
  const bool tells =
      std::regex_match(name, found, cmu) || std::regex_match(name, found, synthesized);
  return tells ? found[1].str() : "";
}

std::string action_of(const std::filesystem::path& file) {
  static const std::regex bandai("dataset-\\d+_(.+)_[^_]+_\\d+"), synthesized("(.+)_s\\d+_\\d+");
  const std::string name = file.stem().string();
  std::smatch found;
  const bool tells =
      std::regex_match(name, found, bandai) || std::regex_match(name, found, synthesized);
  return tells ? found[1].str() : std::filesystem::absolute(file).parent_path().filename().string();
}

}  // namespace mcdbn
