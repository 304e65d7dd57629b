#include "mcdbn/evaluation/limb_error.hpp"

#include <fmt/core.h>

#include <array>
#include <limits>

#include "base/numbers.hpp"
#include "evaluation/procrustes.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/evaluation/joint_error.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {
namespace {

using enum JointRole;
constexpr std::array kLimbJoints{left_shoulder, right_shoulder, left_elbow, right_elbow,
                                 left_wrist,    right_wrist,    left_hip,   right_hip,
                                 left_knee,     right_knee,     left_ankle, right_ankle};
constexpr Eigen::Index kLeftHip = 6, kRightHip = 7;

MatrixD relative_to_hips(const MatrixD& positions) {
  const MatrixD middle =
      (positions.middleCols<3>(3 * kLeftHip) + positions.middleCols<3>(3 * kRightHip)) / 2;
  return positions - middle.replicate(1, positions.cols() / 3);
}

/// Mean length of the 3-vectors in a matrix [frames x 3·joints].
double mean_length(const MatrixD& vectors) {
  const Eigen::Map<const Eigen::Matrix3Xd> points(vectors.data(), 3, vectors.size() / 3);
  return points.colwise().norm().mean();
}

}  // namespace

std::span<const JointRole> limb_joints() {
  return kLimbJoints;
}

MatrixD limb_positions_mm(const Motion& motion) {
  const SkeletonRoles roles = skeleton_roles(motion.skeleton);
  const MatrixD world = world_positions_mm(motion);
  MatrixD positions =
      MatrixD::Constant(motion.frames(), 3 * static_cast<Eigen::Index>(kLimbJoints.size()),
                        std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < kLimbJoints.size(); ++i)
    if (const int joint = roles.joint(kLimbJoints[i]); joint >= 0)
      positions.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = world.middleCols<3>(3 * joint);
  return positions;
}

LimbError limb_error(const MatrixD& truth, const MatrixD& regenerated) {
  const auto columns = 3 * static_cast<Eigen::Index>(kLimbJoints.size());
  if (truth.rows() != regenerated.rows() || truth.rows() == 0 || truth.cols() != columns ||
      regenerated.cols() != columns)
    throw ShapeError(fmt::format("cannot compare limbs of {}x{} and {}x{}: frames x {} are needed",
                                 truth.rows(), truth.cols(), regenerated.rows(), regenerated.cols(),
                                 columns));
  if (truth.hasNaN() || regenerated.hasNaN()) return {kNan, kNan, kNan};
  const MatrixD target = relative_to_hips(truth);
  MatrixD source = relative_to_hips(regenerated);
  LimbError error;
  error.mpjpe_mm = mean_length(source - target);
  MatrixD residual(target.rows(), target.cols());
  for (Eigen::Index frame = 0; frame < target.rows(); ++frame)
    residual.row(frame) = procrustes_residual(target.row(frame), source.row(frame));
  error.pa_mpjpe_mm = mean_length(residual);
  const Eigen::Matrix3d turn = nearest_rotation(target, source);
  for (Eigen::Index joint = 0; joint < columns; joint += 3)
    source.middleCols<3>(joint) = source.middleCols<3>(joint) * turn.transpose();
  error.turned_mpjpe_mm = mean_length(source - target);
  return error;
}

}  // namespace mcdbn
