#include "mcdbn/evaluation/joint_error.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "clips.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

MatrixD random_clip(int frames, int joints, double deviation_mm, unsigned seed) {
  return test::random_clip(frames, 3 * joints, deviation_mm, seed);
}

Eigen::Vector3d joint_at(const MatrixD& clip, int frame, int joint) {
  return clip.row(frame).segment<3>(3 * joint).transpose();
}

/// Every frame of `clip` under its own similarity.
MatrixD moved(const MatrixD& clip) {
  MatrixD result = clip;
  for (int frame = 0; frame < clip.rows(); ++frame) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.3 + frame, Eigen::Vector3d(1, 2, -0.5).normalized()).matrix();
    for (int joint = 0; joint < clip.cols() / 3; ++joint)
      result.row(frame).segment<3>(3 * joint) =
          (1.7 * turn * joint_at(clip, frame, joint) + Eigen::Vector3d(10, frame, -30)).transpose();
  }
  return result;
}

/// Best similarity by Horn's quaternion method, another derivation than Umeyama's: the rotation is
/// the leading eigenvector of a symmetric 4x4 matrix.
double horn_mean_distance(const MatrixD& target, const MatrixD& source, int frame) {
  const int joints = static_cast<int>(target.cols() / 3);
  Eigen::Vector3d target_centre = Eigen::Vector3d::Zero(), source_centre = target_centre;
  for (int j = 0; j < joints; ++j) {
    target_centre += joint_at(target, frame, j) / joints;
    source_centre += joint_at(source, frame, j) / joints;
  }
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  double source_square = 0;
  for (int j = 0; j < joints; ++j) {
    const Eigen::Vector3d a = joint_at(source, frame, j) - source_centre;
    s += a * (joint_at(target, frame, j) - target_centre).transpose();
    source_square += a.squaredNorm();
  }
  Eigen::Matrix4d n;
  n << s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),  //
      s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),   //
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), -s(0, 0) + s(1, 1) - s(2, 2), s(1, 2) + s(2, 1),  //
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), -s(0, 0) - s(1, 1) + s(2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  const Eigen::Matrix3d turn = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).matrix();
  const double scale = (turn * s).trace() / source_square;
  const Eigen::Vector3d shift = target_centre - scale * turn * source_centre;
  double sum = 0;
  for (int j = 1; j < joints; ++j)
    sum += (scale * turn * joint_at(source, frame, j) + shift - joint_at(target, frame, j)).norm();
  return sum / (joints - 1);
}

}  // namespace

TEST_CASE("joint_error: equal clips have none, wherever their roots travel") {
  const MatrixD truth = random_clip(12, 5, 300, 1);
  MatrixD travelled = truth;
  for (int frame = 0; frame < 12; ++frame) travelled.row(frame).array() += 17.0 * frame * frame;
  const JointError error = joint_error(truth, travelled, 30);
  CHECK(error.mpjpe_mm < 1e-9);
  CHECK(error.pa_mpjpe_mm < 1e-9);
  CHECK(error.mpjve_mm_s < 1e-7);
  CHECK(error.acceleration_error_mm_s2 < 1e-5);
  CHECK(error.rmse_mm < 1e-9);
  CHECK(error.pck_150mm == 1);
}

TEST_CASE("joint_error: by hand, two joints beside the root") {
  // Joint 1 is off by 3-4-0 mm times the frame number squared, joint 2 by 200 mm throughout.
  const MatrixD truth = MatrixD::Zero(4, 9);
  MatrixD regenerated = truth;
  for (int frame = 0; frame < 4; ++frame) {
    regenerated.row(frame).segment<3>(3) << 3 * frame * frame, 4 * frame * frame, 0;
    regenerated.row(frame).segment<3>(6) << 0, 0, 200;
  }
  const JointError error = joint_error(truth, regenerated, 10);
  // Joint 1: 0, 5, 20, 45 mm; speed 50, 150, 250 mm/s; acceleration 1000 mm/s².
  CHECK(error.mpjpe_mm == doctest::Approx((70.0 / 4 + 200) / 2));
  CHECK(error.mpjve_mm_s == doctest::Approx(150.0 / 2));
  CHECK(error.acceleration_error_mm_s2 == doctest::Approx(1000.0 / 2));
  CHECK(error.pck_150mm == doctest::Approx(0.5));
  CHECK(error.rmse_mm == doctest::Approx(std::sqrt((2450.0 / 4 + 40000) / 2)));
}

TEST_CASE("joint_error: the root may be any joint") {
  const MatrixD truth = random_clip(6, 4, 200, 3);
  const MatrixD regenerated = truth + random_clip(6, 4, 20, 4);
  double sum = 0;
  for (int frame = 0; frame < 6; ++frame)
    for (const int joint : {0, 1, 3})
      sum += ((joint_at(regenerated, frame, joint) - joint_at(regenerated, frame, 2)) -
              (joint_at(truth, frame, joint) - joint_at(truth, frame, 2)))
                 .norm();
  CHECK(joint_error(truth, regenerated, 30, 2).mpjpe_mm == doctest::Approx(sum / 18));
  CHECK(mean_joint_distance_mm(truth, regenerated, 2) == doctest::Approx(sum / 18));
}

TEST_CASE("pa_mpjpe: similarities cost nothing, mirroring does") {
  const MatrixD truth = random_clip(5, 8, 250, 5);
  CHECK(joint_error(truth, moved(truth), 30).pa_mpjpe_mm < 1e-8);
  CHECK(joint_error(truth, moved(truth), 30).mpjpe_mm > 100);
  MatrixD mirrored = truth;
  for (int joint = 0; joint < 8; ++joint) mirrored.col(3 * joint) *= -1;
  CHECK(joint_error(truth, mirrored, 30).pa_mpjpe_mm > 10);
}

TEST_CASE("pa_mpjpe equals Horn's quaternion method") {
  for (const unsigned seed : {6U, 7U, 8U}) {
    const MatrixD truth = random_clip(9, 7, 250, seed);
    const MatrixD regenerated = moved(truth) + random_clip(9, 7, 60, seed + 50);
    double sum = 0;
    for (int frame = 0; frame < 9; ++frame) sum += horn_mean_distance(truth, regenerated, frame);
    CHECK(joint_error(truth, regenerated, 30).pa_mpjpe_mm ==
          doctest::Approx(sum / 9).epsilon(1e-9));
  }
}

TEST_CASE("pa_mpjpe of a body shrunk to one point is its distance to the centre") {
  const MatrixD truth = random_clip(1, 3, 100, 9);
  const MatrixD point = MatrixD::Zero(1, 9);
  const Eigen::Vector3d centre =
      (joint_at(truth, 0, 0) + joint_at(truth, 0, 1) + joint_at(truth, 0, 2)) / 3;
  const double expected =
      ((joint_at(truth, 0, 1) - centre).norm() + (joint_at(truth, 0, 2) - centre).norm()) / 2;
  CHECK(joint_error(truth, point, 30).pa_mpjpe_mm == doctest::Approx(expected));
}

TEST_CASE("joint_error: too short for a velocity, and shapes that do not fit") {
  const MatrixD truth = random_clip(2, 3, 100, 10);
  CHECK(std::isnan(joint_error(truth.topRows(1), truth.topRows(1), 30).mpjve_mm_s));
  CHECK(std::isnan(joint_error(truth, truth, 30).acceleration_error_mm_s2));
  CHECK(joint_error(truth, truth, 30).mpjve_mm_s == 0);
  CHECK_THROWS_AS(joint_error(truth, truth.topRows(1), 30), ShapeError);
  CHECK_THROWS_AS(joint_error(truth, truth, 30, 3), ShapeError);
  CHECK_THROWS_AS(joint_error(truth.leftCols(8), truth.leftCols(8), 30), ShapeError);
}

}  // namespace mcdbn
