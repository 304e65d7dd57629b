#pragma once

#include <Eigen/Core>
#include <cmath>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// When a foot joint is planted from one frame to the next: near the ground in both frames, and
/// slow. Lengths are those of a body 1.7 m tall.
struct PlantedFoot {
  double within_m = 0.04;  ///< of the ground
  double below_m_s = 0.4;  ///< a tenth of what a walker's swinging foot reaches

  bool holds(double above_ground_m, double speed_m_s) const {
    return above_ground_m <= within_m && speed_m_s <= below_m_s;
  }
  /// From 0 to 1: normal curves of height and speed, whose deviations are those limits.
  double confidence(double above_ground_m, double speed_m_s) const {
    const double high = above_ground_m / within_m, fast = speed_m_s / below_m_s;
    return std::exp(-0.5 * (high * high + fast * fast));
  }
};

/// For captured motion: the ground is the joint's own lowest height of the clip.
inline constexpr PlantedFoot kPlantedInCapture{};
/// For a regenerated pose: the ground is the lowest foot of the frame, itself some centimetres off.
inline constexpr PlantedFoot kPlantedInAnswer{.within_m = 0.05};

/// A joint's step to a frame from the one before.
struct JointStep {
  Eigen::RowVector3d moved;  ///< in the positions' unit
  double height = 0;         ///< the larger height of the two frames, above y = 0
};

/// @param positions [frames x 3·joints], +y up  @param frame 1 at least
inline JointStep step_to(const MatrixD& positions, int joint, Eigen::Index frame) {
  return {
      positions.row(frame).segment<3>(3 * joint) - positions.row(frame - 1).segment<3>(3 * joint),
      positions.col(3 * joint + 1).segment<2>(frame - 1).maxCoeff()};
}

}  // namespace mcdbn
