#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "clips.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/evaluation/limb_error.hpp"

namespace mcdbn {
namespace {

MatrixD turned(const MatrixD& clip, const Eigen::Matrix3d& turn) {
  MatrixD result = clip;
  for (Eigen::Index joint = 0; joint < clip.cols(); joint += 3)
    result.middleCols<3>(joint) = clip.middleCols<3>(joint) * turn.transpose();
  return result;
}

const Eigen::Matrix3d kTurn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();

}  // namespace

TEST_CASE("limb_error: travel costs nothing, a turn of the camera only the plain distance") {
  const MatrixD truth = test::random_clip(9, 36, 300, 1);
  MatrixD travelled = truth;
  for (int frame = 0; frame < 9; ++frame) travelled.row(frame).array() += 40.0 * frame;
  CHECK(limb_error(truth, travelled).mpjpe_mm < 1e-9);
  const LimbError error = limb_error(truth, turned(travelled, kTurn));
  CHECK(error.mpjpe_mm > 50);
  CHECK(error.turned_mpjpe_mm < 1e-9);
  CHECK(error.pa_mpjpe_mm < 1e-9);
  // A turn of each frame is not one of the clip, and another size is neither.
  MatrixD wobbling = truth;
  for (int frame = 0; frame < 9; ++frame)
    wobbling.row(frame) =
        1.1 *
        turned(truth, Eigen::AngleAxisd(0.2 * frame, Eigen::Vector3d::UnitY()).matrix()).row(frame);
  CHECK(limb_error(truth, wobbling).turned_mpjpe_mm > 20);
  CHECK(limb_error(truth, wobbling).pa_mpjpe_mm < 1e-9);
  // No mirror image.
  CHECK(limb_error(truth, -truth).turned_mpjpe_mm > 50);
}

TEST_CASE("limb_error: by hand, over 12 joints relative to the middle of the hips") {
  const MatrixD truth = test::random_clip(4, 36, 300, 2);
  MatrixD other = truth;
  other.col(6).array() += 60;  // the left elbow's x
  CHECK(limb_error(truth, other).mpjpe_mm == doctest::Approx(60.0 / 12));
  other = truth;
  other.col(18).array() += 60;  // the left hip: all others are 30 off, it and its pair too
  CHECK(limb_error(truth, other).mpjpe_mm == doctest::Approx(30.0));
  CHECK(limb_joints().size() == 12);
  CHECK(limb_joints()[2] == JointRole::left_elbow);
  CHECK(limb_joints()[6] == JointRole::left_hip);
  other(2, 5) = std::nan("");
  CHECK(std::isnan(limb_error(truth, other).pa_mpjpe_mm));
  CHECK_THROWS_AS(limb_error(truth, MatrixD(truth.leftCols(33))), ShapeError);
  CHECK_THROWS_AS(limb_error(truth, MatrixD(truth.topRows(3))), ShapeError);
}

}  // namespace mcdbn
