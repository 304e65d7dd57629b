#pragma once

#include <span>

#include "mcdbn/motion/joint_role.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Errors over the joints of limbs that every human skeleton and every detector has (limb_joints),
/// relative to the middle of the hips, in millimetres.
struct LimbError {
  double mpjpe_mm = 0;         ///< mean joint distance
  double turned_mpjpe_mm = 0;  ///< mean joint distance after the one rotation of the whole clip
                               ///< that minimizes it: the camera's orientation does not count
  double pa_mpjpe_mm = 0;      ///< after the best similarity transform of each frame
};

/// Shoulders, elbows, wrists, hips, knees and ankles, left before right: 12.
std::span<const JointRole> limb_joints();

/// Positions of limb_joints() in the world, scaled so that the skeleton is 1.7 m tall, in mm.
/// @return [frames x 36], NaN where the skeleton lacks a joint
MatrixD limb_positions_mm(const Motion& motion);

/// @param truth, regenerated [frames x 36] positions of limb_joints() in mm, wherever their roots
///        are  @return NaN where a joint is NaN throughout  @throws ShapeError
LimbError limb_error(const MatrixD& truth, const MatrixD& regenerated);

}  // namespace mcdbn
