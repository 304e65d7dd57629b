#include "mcdbn/motion/skeleton.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_root.hpp"

namespace mcdbn {
namespace {

/// Size of the box around the rest pose, the body's root at the origin. As `root` stands on the
/// chain of only children, all joints after it are below it.
Eigen::Vector3d rest_extent(const Skeleton& skeleton, int root) {
  std::vector<Eigen::Vector3d> position(skeleton.joints.size(), Eigen::Vector3d::Zero());
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;
  const auto include = [&](const Eigen::Vector3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  };
  for (int i = root; i < skeleton.joint_count(); ++i) {
    const Joint& joint = skeleton.joints[i];
    if (i != root) position[i] = position[joint.parent] + joint.offset;
    include(position[i]);
    for (const Eigen::Vector3d& site : joint.end_sites) include(position[i] + site);
  }
  return high - low;
}

/// Range of a column over a clip's frames; 0 for an empty clip.
double range(const MatrixD& channels, int column) {
  if (channels.rows() == 0) return 0;
  return channels.col(column).maxCoeff() - channels.col(column).minCoeff();
}

/// Whether the position of the joint of that name changes within any of the clips.
bool travels(const std::vector<const Motion*>& clips, const std::string& name) {
  constexpr double kStill = 1e-6;  // below what writers print
  for (const Motion* clip : clips) {
    const int joint = clip->skeleton.find(name);
    if (joint < 0) continue;
    const std::vector<Channel>& channels = clip->skeleton.joints[joint].channels;
    const int first = clip->skeleton.first_channel(joint);
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (!is_rotation(channels[i]) &&
          range(clip->channels, first + static_cast<int>(i)) > kStill) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

int Skeleton::channel_count() const {
  return first_channel(joint_count());
}

int Skeleton::first_channel(int joint) const {
  std::size_t count = 0;
  for (int i = 0; i < joint; ++i) count += joints[i].channels.size();
  return static_cast<int>(count);
}

int Skeleton::find(std::string_view name) const {
  const auto found = std::find_if(joints.begin(), joints.end(),
                                  [&](const Joint& joint) { return joint.name == name; });
  return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

double Skeleton::rest_height(int up_axis) const {
  if (joints.empty()) return 0;
  const Eigen::Vector3d extent = rest_extent(*this, body_root(*this));
  return up_axis >= 0 ? extent[up_axis] : extent.maxCoeff();
}

WorldPose forward_kinematics(const Skeleton& skeleton,
                             const Eigen::Ref<const RowVectorD>& channels) {
  if (channels.size() != skeleton.channel_count()) {
    throw ShapeError(fmt::format("forward_kinematics: {} values for a skeleton of {} channels",
                                 channels.size(), skeleton.channel_count()));
  }
  WorldPose pose;
  pose.world_from_joint.reserve(skeleton.joints.size());
  pose.position.reserve(skeleton.joints.size());
  const double* joint_channels = channels.data();
  for (const Joint& joint : skeleton.joints) {
    Eigen::Vector3d offset = joint.offset;
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const Channel channel = joint.channels[i];
      if (!is_rotation(channel)) offset[axis_of(channel)] = joint_channels[i];
    }
    const Eigen::Matrix3d parent_from_joint = local_rotation(joint, joint_channels);
    if (joint.parent < 0) {
      pose.world_from_joint.push_back(parent_from_joint);
      pose.position.push_back(offset);
    } else {
      const Eigen::Matrix3d& world_from_parent = pose.world_from_joint[joint.parent];
      pose.position.emplace_back(pose.position[joint.parent] + world_from_parent * offset);
      pose.world_from_joint.emplace_back(world_from_parent * parent_from_joint);
    }
    joint_channels += joint.channels.size();
  }
  return pose;
}

Eigen::Vector3d local_position(const Joint& joint, const double* joint_channels) {
  Eigen::Vector3d position = joint.offset;
  for (std::size_t k = 0; k < joint.channels.size(); ++k) {
    if (!is_rotation(joint.channels[k])) position[axis_of(joint.channels[k])] = joint_channels[k];
  }
  return position;
}

MatrixD joint_positions(const Motion& motion) {
  const int joints = motion.skeleton.joint_count();
  MatrixD positions(motion.frames(), 3 * joints);
  for (int frame = 0; frame < motion.frames(); ++frame) {
    check_interruption();
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(frame));
    for (int joint = 0; joint < joints; ++joint) {
      positions.block<1, 3>(frame, 3 * joint) = pose.position[joint].transpose();
    }
  }
  return positions;
}

int moving_root(const std::vector<const Motion*>& clips) {
  if (clips.empty()) return 0;
  const Skeleton& skeleton = clips.front()->skeleton;
  if (skeleton.joints.empty()) return 0;
  int root = 0;
  for (int joint = 0; joint >= 0; joint = only_child(skeleton, joint)) {
    if (travels(clips, skeleton.joints[joint].name)) root = joint;
  }
  return root;
}

}  // namespace mcdbn
