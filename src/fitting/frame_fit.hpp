#pragma once

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// A part of a joint's way from the root that one orientation turns: camera axes.
struct Lever {
  int turn = 0;  ///< index of the orientation
  Eigen::Vector3d bone{0, 0, 0};
};

/// One joint as one frame saw it: along `ray` (x/z and y/z), with that variance on each of both.
struct Observation {
  std::vector<Lever> levers;  ///< root to joint
  Eigen::Vector2d ray{0, 0};
  double variance = 0;
};

/// How far from the camera a joint is known to be, along the camera's axis.
struct HeldDepth {
  std::vector<Lever> levers;  ///< root to joint
  double depth = 0;
  double variance = 0;
};

/// A frame before its track is looked at.
struct FramePrior {
  Eigen::Vector3d root{0, 0, 0};  ///< its position, camera axes
  /// By orientation, the one that it hangs from, or −1; those come first.
  std::vector<int> parents;
  std::vector<double> turn_deviation_rad;  ///< of each orientation's turn about each axis, above 0
  double likeness = 0;                     ///< correlation of a turn with its parent's
  double root_deviation = 1;               ///< of the root's position, in its units
  Eigen::VectorXd expected;                ///< mean of the correction; empty: zero
  std::vector<HeldDepth> held;             ///< what is known besides the rays
};

/// Rotation by the vector's length about it.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad);

/// Where the joint is when the orientations are turned and the root is moved.
/// @param correction three numbers a turn (radians), then the root's shift
Eigen::Vector3d corrected_position(const std::vector<Lever>& levers, const Eigen::Vector3d& root,
                                   const Eigen::VectorXd& correction);

/// d ray / d correction of a joint. @return [2 x correction.size()]
Eigen::Matrix<double, 2, Eigen::Dynamic> ray_jacobian(const Observation& observation,
                                                      const Eigen::Vector3d& root,
                                                      const Eigen::VectorXd& correction);

struct FrameFit {
  Eigen::VectorXd correction;  ///< three numbers a turn (radians), then the root's shift
  std::vector<double>
      residuals;  ///< what the rays are still off by, in their deviations; two a observation
};

/// The most likely correction: Gauss-Newton on rays, held depths and prior together, halving steps
/// that make it worse. Cauchy's weights let go of joints that nothing likely explains; joints
/// behind the camera do not count. What is expected if nothing is seen, or if the root is behind
/// the camera.
FrameFit fit_frame(const std::vector<Observation>& observations, const FramePrior& prior);

/// How many of the fit's residuals its correction does not use up: the trace of how much of a
/// change of the rays stays a miss. 0 if nothing was seen.
double freedom_of(const FrameFit& fit, const std::vector<Observation>& observations,
                  const FramePrior& prior);

}  // namespace mcdbn
