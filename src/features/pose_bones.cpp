#include "features/pose_bones.hpp"

#include <algorithm>

#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// Which block turns a joint, and how the joint stands in that block's frame.
struct Turned {
  int block = -1;
  Eigen::Matrix3d block_from_joint = Eigen::Matrix3d::Identity();
  int bone = -1;  ///< that ends at the joint, -1 at the root
};

}  // namespace

std::vector<PoseBone> pose_bones(const PoseFeatures& features) {
  constexpr double kShortest = 1e-6;
  const Skeleton& skeleton = features.skeleton();
  const double metres = 1.0 / file_units_per_metre(skeleton);
  std::vector<PoseBone> bones;
  std::vector<Turned> turned(skeleton.joints.size());
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const auto block = std::find(features.joints().begin(), features.joints().end(), j);
    if (block != features.joints().end())
      turned[j].block = static_cast<int>(block - features.joints().begin());
    if (joint.parent < 0 || j <= features.root()) continue;  // joints before the root are above it
    const Turned& parent = turned[joint.parent];
    if (parent.block < 0) continue;  // turned by no orientation
    const double* channels = features.fixed_channels().data() + skeleton.first_channel(j);
    if (turned[j].block < 0) {
      turned[j].block = parent.block;
      turned[j].block_from_joint = parent.block_from_joint * local_rotation(joint, channels);
    }
    const Eigen::Vector3d lever =
        metres * (parent.block_from_joint * local_position(joint, channels));
    turned[j].bone = parent.bone;
    if (lever.norm() < kShortest) continue;
    turned[j].bone = static_cast<int>(bones.size());
    bones.push_back({parent.bone, parent.block, lever, j});
  }
  return bones;
}

}  // namespace mcdbn
