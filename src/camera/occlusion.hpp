#pragma once

#include <Eigen/Core>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/keypoint.hpp"

namespace mcdbn {

using Flags = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A body as far as it can stand in the camera's way: where the joints of each role are.
struct RolePositions {
  MatrixD positions;  ///< [frames x 3·roles] in the order of joint_roles(), NaN where there is none
  double height = 0;  ///< of the body, file units

  Eigen::Vector3d at(Eigen::Index frame, JointRole role) const {
    return positions.row(frame).segment<3>(3 * static_cast<Eigen::Index>(role)).transpose();
  }
};

/// Which places the camera cannot see because a limb, the trunk or the head is before them. Trunk,
/// head and the parts of limbs are round rods between two joints; none hides what it carries.
/// @param places [frames x 3·keypoints] of `keypoints`, world
/// @return [frames x keypoints]
Flags hidden_places(const RolePositions& body, const std::vector<Keypoint>& keypoints,
                    const MatrixD& places, const Camera& camera);

}  // namespace mcdbn
