#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Errors of one regenerated clip against the truth, over forward kinematics, root-relative, in
/// millimetres on a 1.7 m body. Both clips have the same joint names and number of frames; what is
/// compared is motion, so both are put on the truth's skeleton first by the caller.
struct JointError {
  double mpjpe_mm = 0;     ///< mean over frames and joints but the root
  double pa_mpjpe_mm = 0;  ///< after the best similarity transform of each frame (Procrustes)
  double mpjve_mm_s = 0;   ///< mean joint velocity error
  double acceleration_error_mm_s2 = 0;
  double pck_150mm = 0;  ///< fraction of joints within 150 mm
  double rmse_mm = 0;    ///< whole body
};

/// @param truth, regenerated [frames x 3·joints] positions in millimetres  @throws ShapeError
JointError joint_error(const MatrixD& truth, const MatrixD& regenerated, double fps,
                       int root_joint = 0);

/// Positions relative to joint `root_joint`, scaled so that the skeleton is 1.7 m tall, in mm.
MatrixD root_relative_positions_mm(const Motion& motion, int root_joint = 0);

}  // namespace mcdbn
