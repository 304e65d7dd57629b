#include "fitting/planted_velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

constexpr double kLow_m = 0.05, kSlow_m_s = 0.4;
/// What the given velocity counts beside a foot that surely stands.
constexpr double kGivenWeight = 0.1;

/// How surely a foot stands.
double contact(double above_lowest_m, double speed_m_s) {
  const double high = above_lowest_m / kLow_m, fast = speed_m_s / kSlow_m_s;
  return std::exp(-0.5 * (high * high + fast * fast));
}

}  // namespace

MatrixD planted_velocity(const Motion& motion, int root, const std::vector<int>& feet,
                         const MatrixD& velocity) {
  if (velocity.rows() != motion.frames() || velocity.cols() != 3) {
    throw ShapeError(fmt::format("planted_velocity: {}x{} velocities of {} frames", velocity.rows(),
                                 velocity.cols(), motion.frames()));
  }
  if (feet.empty()) return velocity;
  const MatrixD positions = joint_positions(motion);
  const double metres = 1 / file_units_per_metre(motion.skeleton);
  const auto step = [&](Eigen::Index frame, int joint) -> Eigen::RowVector3d {
    return (positions.row(frame).segment<3>(3 * joint) -
            positions.row(frame - 1).segment<3>(3 * joint)) *
           motion.fps();
  };
  const auto height = [&](Eigen::Index frame, int foot) {
    return positions.col(3 * foot + 1).segment<2>(frame - 1).maxCoeff();
  };
  MatrixD result = velocity;
  for (Eigen::Index frame = 1; frame < result.rows(); ++frame) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int foot : feet) lowest = std::min(lowest, height(frame, foot));
    Eigen::RowVector3d sum = kGivenWeight * velocity.row(frame);
    double total = kGivenWeight;
    for (const int foot : feet) {
      const Eigen::RowVector3d moved = step(frame, foot);
      const double weight = contact(metres * (height(frame, foot) - lowest), metres * moved.norm());
      sum += weight * (step(frame, root) - moved);
      total += weight;
    }
    result.row(frame) = sum / total;
  }
  // The first frame repeats the second, as in the features.
  if (result.rows() > 1) result.row(0) = result.row(1);
  return result;
}

}  // namespace mcdbn
