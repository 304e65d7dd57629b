#include "motion/joint_uncertainty.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// @return [frames x 3·joints], all but joint 0 from joint 0
MatrixD about_root(const Motion& motion) {
  MatrixD positions = joint_positions(motion);
  const MatrixD root = positions.leftCols<3>();
  for (Eigen::Index column = 3; column < positions.cols(); column += 3)
    positions.middleCols<3>(column) -= root;
  return positions;
}

}  // namespace

MatrixD joint_uncertainty(const Motion& likeliest, const std::vector<Motion>& draws) {
  const MatrixD centre = about_root(likeliest);
  MatrixD squares = MatrixD::Zero(centre.rows(), centre.cols());
  for (const Motion& draw : draws) {
    const MatrixD drawn = about_root(draw);
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
