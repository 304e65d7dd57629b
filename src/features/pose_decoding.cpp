#include <fmt/format.h>

#include <Eigen/Geometry>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/features/pose_features.hpp"
#include "motion/joint_matching.hpp"

namespace mcdbn {

namespace {

/// One joint of the output skeleton and what the model has for it.
struct DecodedJoint {
  const Joint* joint = nullptr;
  int channel = 0;                    ///< first column of its channels
  const Joint* model = nullptr;       ///< the model's joint of that name, or null
  const double* constants = nullptr;  ///< the model's constant channels of that joint
  int feature = -1;                   ///< first column of its 6D block, or -1
  int leading_axis = 0;               ///< of that block
};

/// The rotation whose leading column is along that of the block, and the other of its first two as
/// near as can be (Gram-Schmidt); `otherwise` where they determine none (zero, parallel or
/// not finite).
Eigen::Matrix3d orthonormal(const double* block, int leading_axis,
                            const Eigen::Matrix3d& otherwise) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 2>> axes(block);
  const Eigen::Vector3d first = axes.col(leading_axis).normalized();
  const auto second = axes.col(1 - leading_axis);
  const Eigen::Vector3d rest = second - first.dot(second) * first;
  if (!(rest.norm() > 1e-9 && first.norm() > 0.5)) return otherwise;
  Eigen::Matrix3d rotation;
  rotation.col(leading_axis) = first;
  rotation.col(1 - leading_axis) = rest.normalized();
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  return rotation;
}

/// The joint's channels without a feature: the training constants, put in this joint's own
/// channel order and shifted to its own OFFSET; at rest where the model has no such joint.
RowVectorD constant_channels(const DecodedJoint& decoded) {
  const Joint& joint = *decoded.joint;
  RowVectorD channels = RowVectorD::Zero(static_cast<Eigen::Index>(joint.channels.size()));
  const bool same_order = decoded.model && joint.channels == decoded.model->channels;
  if (decoded.model && !same_order) {
    set_local_rotation(joint, local_rotation(*decoded.model, decoded.constants), nullptr,
                       channels.data());
  }
  for (std::size_t k = 0; k < joint.channels.size(); ++k) {
    const int axis = axis_of(joint.channels[k]);
    const int at = decoded.model ? find_channel(*decoded.model, joint.channels[k]) : -1;
    if (!is_rotation(joint.channels[k])) {
      channels[k] = joint.offset[axis];
      if (at >= 0) channels[k] += decoded.constants[at] - decoded.model->offset[axis];
    } else if (same_order) {
      channels[k] = decoded.constants[k];
    }
  }
  return channels;
}

/// Writes `position` (in the parent's frame) into the joint's position channels.
void set_local_position(const Joint& joint, const Eigen::Vector3d& position, double* channels) {
  for (std::size_t k = 0; k < joint.channels.size(); ++k) {
    if (!is_rotation(joint.channels[k])) channels[k] = position[axis_of(joint.channels[k])];
  }
}

/// Fills one frame after the other; each starts from the one before, so that angles run on.
class FrameDecoder {
 public:
  FrameDecoder(std::vector<DecodedJoint> joints, const Joint* root,
               const Eigen::Matrix3d& camera_from_world)
      : joints_(std::move(joints)),
        root_(root),
        world_from_camera_(camera_from_world.transpose()),
        camera_from_joint_(joints_.size(), Eigen::Matrix3d::Identity()),
        world_from_joint_(joints_.size()),
        position_(joints_.size()) {}

  /// @param previous the channels of the frame before, or null
  /// @param channels of this frame, holding the constants on entry
  void decode(const double* features, const Eigen::Vector3d& root_position, const double* previous,
              double* channels) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const DecodedJoint& decoded = joints_[j];
      const Joint& joint = *decoded.joint;
      double* own = channels + decoded.channel;
      Eigen::Matrix3d world_from_parent = Eigen::Matrix3d::Identity();
      Eigen::Vector3d parent_position = Eigen::Vector3d::Zero();
      if (joint.parent >= 0) {
        world_from_parent = world_from_joint_[joint.parent];
        parent_position = position_[joint.parent];
      }
      if (decoded.model == root_) {
        set_local_position(joint, world_from_parent.transpose() * (root_position - parent_position),
                           own);
      }
      if (decoded.feature >= 0) {
        camera_from_joint_[j] =
            orthonormal(features + decoded.feature, decoded.leading_axis, camera_from_joint_[j]);
        set_local_rotation(
            joint, world_from_parent.transpose() * world_from_camera_ * camera_from_joint_[j],
            previous ? previous + decoded.channel : nullptr, own);
      }
      // From the channels, not from the wish: what the joint cannot express its children make up.
      position_[j] = parent_position + world_from_parent * local_position(joint, own);
      world_from_joint_[j] = world_from_parent * local_rotation(joint, own);
    }
  }

 private:
  std::vector<DecodedJoint> joints_;
  const Joint* root_;
  Eigen::Matrix3d world_from_camera_;
  std::vector<Eigen::Matrix3d> camera_from_joint_, world_from_joint_;
  std::vector<Eigen::Vector3d> position_;
};

}  // namespace

Motion PoseFeatures::decode(const MatrixD& features, const Eigen::Matrix3d& camera_from_world,
                            const Skeleton& skeleton, double fps,
                            const MatrixD& root_position) const {
  if (features.cols() != dimension() || root_position.rows() != features.rows() ||
      root_position.cols() != 3) {
    throw ShapeError(fmt::format(
        "PoseFeatures::decode: features {}x{} and root positions {}x{}, expected {} columns, and "
        "as many rows of 3",
        features.rows(), features.cols(), root_position.rows(), root_position.cols(), dimension()));
  }
  std::vector<DecodedJoint> joints(skeleton.joints.size());
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    joints[j].joint = &skeleton.joints[j];
    joints[j].channel = skeleton.first_channel(j);
  }
  const std::vector<int> match = match_joints(skeleton_, skeleton, "the skeleton");
  for (int j = 0; j < skeleton_.joint_count(); ++j) {
    joints[match[j]].model = &skeleton_.joints[j];
    joints[match[j]].constants = constant_channels_.data() + skeleton_.first_channel(j);
  }
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    joints[match[joints_[k]]].feature = kBlock * static_cast<int>(k);
    joints[match[joints_[k]]].leading_axis = leading_axes_[k];
  }
  Motion motion{skeleton, 1.0 / fps, MatrixD(features.rows(), skeleton.channel_count())};
  for (const DecodedJoint& joint : joints) {
    const RowVectorD constants = constant_channels(joint);
    motion.channels.middleCols(joint.channel, constants.size()) =
        constants.replicate(features.rows(), 1);
  }
  FrameDecoder decoder(std::move(joints), &skeleton_.joints[root_], camera_from_world);
  for (int frame = 0; frame < motion.frames(); ++frame) {
    decoder.decode(features.row(frame).data(), root_position.row(frame).transpose(),
                   frame == 0 ? nullptr : motion.channels.row(frame - 1).data(),
                   motion.channels.row(frame).data());
  }
  return motion;
}

}  // namespace mcdbn
