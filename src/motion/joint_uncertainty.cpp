#include "motion/joint_uncertainty.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// @return [frames x 3·joints], the joints after the root from it
MatrixD about_root(const Motion& motion, int root) {
  MatrixD positions = joint_positions(motion);
  const MatrixD path = positions.middleCols<3>(3 * root);
  for (Eigen::Index column = 3 * (root + 1); column < positions.cols(); column += 3)
    positions.middleCols<3>(column) -= path;
  return positions;
}

}  // namespace

MatrixD joint_uncertainty(const Motion& likeliest, const std::vector<Motion>& draws, int root) {
  const MatrixD centre = about_root(likeliest, root);
  MatrixD squares = MatrixD::Zero(centre.rows(), centre.cols());
  for (const Motion& draw : draws) {
    const MatrixD drawn = about_root(draw, root);
    if (drawn.rows() != centre.rows() || drawn.cols() != centre.cols())
      throw ShapeError(
          fmt::format("joint_uncertainty: a draw of {} frames and {} joints, expected "
                      "{} and {}",
                      drawn.rows(), drawn.cols() / 3, centre.rows(), centre.cols() / 3));
    squares += (drawn - centre).cwiseAbs2();
  }
  if (draws.empty()) return squares;
  return (squares / static_cast<double>(draws.size())).cwiseSqrt();
}

}  // namespace mcdbn
