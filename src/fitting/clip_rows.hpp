#pragma once

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/fitting/pose_prior.hpp"

namespace mcdbn {

/// What is given of consecutive frames of a growing clip, a row each.
struct ClipRows {
  PosePrior prior;
  MatrixD mean;       ///< the prior's, not standardized, along the camera's axes
  MatrixD mean_lean;  ///< [frames x 3] how the camera leaned that it was seen by
  MatrixD root_m;     ///< [frames x 3] where the root is, camera axes, metres of a 1.7 m body
  Track2d track;

  Eigen::Index frames() const { return mean.rows(); }
  ClipRows first(Eigen::Index count) const;
  void drop_first(Eigen::Index count);
  void append(const ClipRows& more);
};

}  // namespace mcdbn
