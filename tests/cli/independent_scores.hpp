#pragma once

#include <map>
#include <string>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn::test {

/// Every figure of an evaluation from two motions of the same joint names, by code of the tests'
/// own: forward kinematics, correlations, distances, Procrustes by Horn's quaternion.
/// @param camera_from_world along whose axes the correlation per channel is taken
std::map<std::string, double> independent_scores(const Motion& truth, const Motion& regenerated,
                                                 const Eigen::Matrix3d& camera_from_world);

}  // namespace mcdbn::test
