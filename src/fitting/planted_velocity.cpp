#include "fitting/planted_velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/planted_foot.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// What the given velocity counts beside a foot that surely stands: little, as it is to decide only
/// where none does.
constexpr double kGivenWeight = 0.1;

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
  const auto speed_of = [&](Eigen::Index frame, int joint) -> Eigen::RowVector3d {
    return step_to(positions, joint, frame).moved * motion.fps();
  };
  MatrixD result = velocity;
  for (Eigen::Index frame = 1; frame < result.rows(); ++frame) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int foot : feet) lowest = std::min(lowest, step_to(positions, foot, frame).height);
    Eigen::RowVector3d sum = kGivenWeight * velocity.row(frame);
    double total = kGivenWeight;
    for (const int foot : feet) {
      const Eigen::RowVector3d moved = speed_of(frame, foot);
      const double height = step_to(positions, foot, frame).height;
      const double weight =
          kPlantedInAnswer.surely(metres * (height - lowest), metres * moved.norm());
      sum += weight * (speed_of(frame, root) - moved);
      total += weight;
    }
    result.row(frame) = sum / total;
  }
  // The first frame repeats the second, as in the features.
  if (result.rows() > 1) result.row(0) = result.row(1);
  return result;
}

}  // namespace mcdbn
