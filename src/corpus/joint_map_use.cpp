#include "corpus/joint_map_use.hpp"

#include <fmt/format.h>

#include "base/shown.hpp"

namespace mcdbn {

void JointMapUse::add(const Skeleton& skeleton) {
  std::erase_if(unused_, [&](const auto& line) { return skeleton.find(line.second) >= 0; });
}

std::vector<std::string> JointMapUse::notices() const {
  std::vector<std::string> notices;
  for (const auto& [role, joint] : unused_)
    notices.push_back(fmt::format("the joint map's {} is {}, and no clip has a joint of that name",
                                  name_of(role), shown(joint)));
  return notices;
}

}  // namespace mcdbn
