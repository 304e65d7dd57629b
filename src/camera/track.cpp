#include "mcdbn/camera/track.hpp"

#include <algorithm>

namespace mcdbn {

int Track2d::find(const std::string& name) const {
  const auto found = std::find(joint_names.begin(), joint_names.end(), name);
  return found == joint_names.end() ? -1 : static_cast<int>(found - joint_names.begin());
}

}  // namespace mcdbn
