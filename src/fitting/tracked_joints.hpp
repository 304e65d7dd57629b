#pragma once

#include <string>
#include <vector>

#include "mcdbn/features/track_features.hpp"

namespace mcdbn {

/// The joints that the model looks at: others, such as a node that stays on the floor, may move in
/// the file unlike anything that a camera sees.
inline std::vector<std::string> tracked_joints(const TrackFeatures& features) {
  std::vector<std::string> names = features.joint_names();
  names.push_back(features.root_name());
  return names;
}

}  // namespace mcdbn
