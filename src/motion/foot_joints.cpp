#include "motion/foot_joints.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace mcdbn {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

}  // namespace

std::vector<int> foot_joints(const Skeleton& skeleton) {
  constexpr std::array kParts = {"foot", "toe", "ankle"};
  std::vector<int> feet;
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    const std::string name = lower_case(skeleton.joints[static_cast<std::size_t>(joint)].name);
    if (std::any_of(kParts.begin(), kParts.end(),
                    [&](const char* part) { return name.find(part) != std::string::npos; }))
      feet.push_back(joint);
  }
  return feet;
}

}  // namespace mcdbn
