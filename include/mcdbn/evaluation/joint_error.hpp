#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Errors of one regenerated clip against the truth, over forward kinematics, root-relative, in
/// millimetres on a 1.7 m body. Both clips have the same joint names and number of frames; what is
/// compared is motion, so both are put on the truth's skeleton first by the caller. Every figure
/// is over frames and all joints but the root.
struct JointError {
  double mpjpe_mm = 0;                  ///< mean joint distance
  double pa_mpjpe_mm = 0;               ///< after the best similarity transform of each frame
                                        ///< (Procrustes, over all joints; no mirroring)
  double mpjve_mm_s = 0;                ///< mean joint velocity error; NaN below 2 frames
  double acceleration_error_mm_s2 = 0;  ///< mean joint acceleration error; NaN below 3 frames
  double pck_150mm = 0;                 ///< fraction of joints within 150 mm
  double rmse_mm = 0;                   ///< root of the mean squared joint distance (whole body)
};

/// @param truth, regenerated [frames x 3·joints] positions in millimetres; taken relative to
///        `root_joint` here, so either may still carry the root's travel
/// @param fps frames a second (Hz)
/// @throws ShapeError if shapes differ or there is no joint but the root
JointError joint_error(const MatrixD& truth, const MatrixD& regenerated, double fps,
                       int root_joint = 0);

/// JointError::mpjpe_mm alone. @throws ShapeError as joint_error
double mean_joint_distance_mm(const MatrixD& truth, const MatrixD& regenerated, int root_joint = 0);

/// Positions in the world, scaled so that the skeleton is 1.7 m tall, in mm.
/// @return [frames x 3·joints]
MatrixD world_positions_mm(const Motion& motion);

/// Positions relative to joint `root_joint`, scaled so that the skeleton is 1.7 m tall, in mm.
/// @return [frames x 3·joints]
MatrixD root_relative_positions_mm(const Motion& motion, int root_joint = 0);

}  // namespace mcdbn
