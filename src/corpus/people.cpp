#include "corpus/people.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

namespace mcdbn {

std::size_t PeopleCount::number_of(const Skeleton& skeleton) {
  std::vector<double> bones;
  for (const Joint& joint : skeleton.joints) bones.push_back(joint.offset.norm());
  const auto same = [&](const std::vector<double>& other) {
    return std::equal(bones.begin(), bones.end(), other.begin(), other.end(),
                      [](double x, double y) { return std::abs(x - y) <= 1e-3 * std::abs(x); });
  };
  const auto found = std::find_if(bones_.begin(), bones_.end(), same);
  const auto number = static_cast<std::size_t>(found - bones_.begin());
  if (found == bones_.end()) bones_.push_back(std::move(bones));
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

}  // namespace mcdbn
