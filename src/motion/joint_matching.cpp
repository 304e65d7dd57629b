#include "motion/joint_matching.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

std::vector<int> match_joints(const Skeleton& wanted, const Skeleton& skeleton,
                              std::string_view what) {
  std::vector<int> matches;
  std::string missing;
  for (const Joint& joint : wanted.joints) {
    const int match = skeleton.find(joint.name);
    if (match >= 0 && std::find(matches.begin(), matches.end(), match) != matches.end()) {
      throw InputError(
          fmt::format("{} has two joints named {}; rename one of them", what, joint.name));
    }
    matches.push_back(match);
    if (matches.back() < 0) missing += (missing.empty() ? "" : ", ") + joint.name;
  }
  if (!missing.empty()) {
    throw InputError(fmt::format(
        "{} lacks the joints {}; use files whose joints have the same names", what, missing));
  }
  return matches;
}

int find_channel(const Joint& joint, Channel channel) {
  const auto found = std::find(joint.channels.begin(), joint.channels.end(), channel);
  return found == joint.channels.end() ? -1 : static_cast<int>(found - joint.channels.begin());
}

}  // namespace mcdbn
