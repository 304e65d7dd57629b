#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The 3D modality: for every joint whose rotation varies over the training clips its orientation
/// in the camera's frame, 6D (first two columns of camera_from_joint), then root height and root
/// velocity in the camera's frame, in metres on a 1.7 m body (and per second). See
/// docs/concepts.md. The moving root always has its 6D block; joints that never turn against their
/// parent carry no feature and are restored exactly.
class PoseFeatures {
 public:
  /// Learns which joints move, and the constant channels of all others, from training clips that
  /// share joint names. @throws InputError if a clip lacks a joint that the first one has
  static PoseFeatures fit(const std::vector<const Motion*>& clips);

  static constexpr int kBlock = 6;  ///< numbers of one orientation; the blocks stand first

  int dimension() const;
  /// Fitted: the first clip's; the humanoid has its orders of axes (with_humanoid_orders).
  const Skeleton& skeleton() const { return skeleton_; }
  /// Where the root velocity's three features begin; the height stands before them.
  int velocity_feature() const { return dimension() - 3; }
  int root() const { return root_; }  ///< the moving root: a joint of skeleton()
  /// The joints of skeleton() that have a 6D block, in the blocks' order.
  const std::vector<int>& joints() const { return joints_; }
  /// Which of a block's two axes is kept where they are not at right angles, 0: x, 1: y. It is the
  /// one that is more along the joint's longest bone, so that this axis alone shows where the bone
  /// ends, and the other how the bone is turned about its length.
  int leading_axis(int block) const { return leading_axes_[static_cast<std::size_t>(block)]; }
  /// Values of the channels of joints without features, [1 x channels]; see decode.
  const RowVectorD& fixed_channels() const { return constant_channels_; }
  std::vector<std::string> feature_names() const;

  /// Height is along the world's +y; velocity is the backward difference (the first frame repeats
  /// the second), so that summing it up on output gives the positions back.
  /// @param clip any skeleton with the same joint names, at the model's rate
  /// @return [frames x dimension]  @throws InputError if the clip lacks a joint
  MatrixD encode(const Motion& clip, const Eigen::Matrix3d& camera_from_world) const;

  /// Back to channels on `skeleton` (the model's own or any with the same joint names), angles
  /// continuous. 6D blocks are made orthonormal by Gram-Schmidt from their leading axis on; joints
  /// without features take their parent's motion times their constant local rotation. Position
  /// channels of other joints than the moving root stay as far from the joint's OFFSET as they were
  /// on average in training.
  /// @param features [frames x dimension]  @param root_position [frames x 3] world, file units
  /// @throws ShapeError, InputError if `skeleton` lacks a joint
  Motion decode(const MatrixD& features, const Eigen::Matrix3d& camera_from_world,
                const Skeleton& skeleton, double fps, const MatrixD& root_position) const;

  /// Root height and velocity of the features. @return [frames x 4]: height_m, v_x, v_y,
  /// v_z (camera's frame, m/s on a 1.7 m body)
  MatrixD root_features(const MatrixD& features) const;

  /// Turns the poses to the axes of another camera.
  /// @param features [frames x dimension]  @param other_from_camera rotation  @throws ShapeError
  MatrixD turned(const MatrixD& features, const Eigen::Matrix3d& other_from_camera) const;

  /// Features that were fitted before. @param joints, fixed_channels as those functions give them
  /// @throws InputError where sizes do not fit together
  static PoseFeatures restored(Skeleton skeleton, int root, std::vector<int> joints,
                               const RowVectorD& fixed_channels);

 private:
  void find_leading_axes();

  static constexpr int kRootFeatures = 4;  ///< height, velocity

  Skeleton skeleton_;
  int root_ = 0;                   ///< the moving root (see moving_root)
  std::vector<int> joints_;        ///< indices of the joints with features
  RowVectorD constant_channels_;   ///< [1 x channels], what joints without features take
  std::vector<int> leading_axes_;  ///< by block
};

}  // namespace mcdbn
