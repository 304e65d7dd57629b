// The room motion: skeletons and their motion: kinematics, rotations, resampling, body size, mirror
// images, feet. It uses base. Add here: what needs no camera and no file format.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

enum class Channel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

constexpr bool is_rotation(Channel channel) {
  return channel >= Channel::x_rotation;
}
/// 0, 1 or 2 for x, y, z.
constexpr int axis_of(Channel channel) {
  return static_cast<int>(channel) % 3;
}

struct Joint {
  std::string name;
  int parent = -1;                         ///< index into Skeleton::joints, -1 for the root
  Eigen::Vector3d offset{0, 0, 0};         ///< rest position in the parent's frame, file units
  std::vector<Channel> channels;           ///< in the file's own order
  std::vector<Eigen::Vector3d> end_sites;  ///< offsets of the End Sites below this joint
};

/// A tree of joints in the file's order: parents stand before their children, joint 0 is the root.
struct Skeleton {
  std::vector<Joint> joints;

  int joint_count() const { return static_cast<int>(joints.size()); }
  int channel_count() const;
  /// Column of the first channel of `joint` in Motion::channels.
  int first_channel(int joint) const;
  /// Index of the joint of that name, or -1.
  int find(std::string_view name) const;
  /// Height of the rest pose (all rotations zero), end sites included, along `up_axis` (0, 1, 2)
  /// in file units. The largest extent over the three axes if `up_axis` is negative. The offset of
  /// a body whose root stands below a fixed one (Bandai's Hips below joint_Root) does not count.
  double rest_height(int up_axis = -1) const;
};

/// One clip: a skeleton and its channels over time.
struct Motion {
  Skeleton skeleton;
  double frame_time_s = 1.0 / 30.0;
  MatrixD channels;  ///< [frames x channel_count], degrees and file units

  int frames() const { return static_cast<int>(channels.rows()); }
  double fps() const { return 1.0 / frame_time_s; }
};

/// Every joint's placement in the world at one frame.
struct WorldPose {
  std::vector<Eigen::Matrix3d> world_from_joint;  ///< rotation
  std::vector<Eigen::Vector3d> position;          ///< file units
};

/// Forward kinematics of one frame. Rotation channels multiply in the file's order
/// (`Zrotation Xrotation Yrotation` is Rz·Rx·Ry); position channels REPLACE the joint's offset.
/// @param channels [1 x channel_count]
/// @throws ShapeError
WorldPose forward_kinematics(const Skeleton& skeleton,
                             const Eigen::Ref<const RowVectorD>& channels);

/// Forward kinematics of a clip, in file units.
/// @return [frames x 3·joints], x y z of joint 0, then of joint 1 …
MatrixD joint_positions(const Motion& motion);

/// Where the joint's channels put it in its parent's frame: its offset, or its position channels.
Eigen::Vector3d local_position(const Joint& joint, const double* joint_channels);

/// The joint's rotation matrix parent_from_joint from its rotation channels (degrees).
Eigen::Matrix3d local_rotation(const Joint& joint, const double* joint_channels);

/// Writes the rotation channels (degrees) of `joint` so that they reproduce `parent_from_joint`,
/// choosing among the equivalent triples and turns of 360° the one nearest to `previous`
/// (the joint's channels one frame earlier, or null), so that angles run on continuously.
/// Handles any of the orders of three distinct axes, and joints with fewer rotation channels
/// (nearest rotation that they can express).
void set_local_rotation(const Joint& joint, const Eigen::Matrix3d& parent_from_joint,
                        const double* previous, double* joint_channels);

/// The joint that carries the body through space: of joint 0 and its chain of only children the
/// last one whose position channels vary within any of the clips, else joint 0. So it is the hips
/// also where a joint above them travels in some of the clips (Bandai's joint_Root).
int moving_root(const std::vector<const Motion*>& clips);

}  // namespace mcdbn
