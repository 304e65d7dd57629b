#pragma once

#include <string>
#include <vector>

#include "mcdbn/features/track_features.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The joints that the model looks at: others, such as a node that stays on the floor, may move in
/// the file unlike anything that a camera sees.
std::vector<std::string> tracked_joints(const TrackFeatures& features);

/// Where those joints are from the root. @return [frames x 3·names] world axes, file units
MatrixD positions_about(const std::string& root, const std::vector<std::string>& names,
                        const Motion& motion);

}  // namespace mcdbn
