#include "fitting/usual_body.hpp"

#include <array>

#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn {
namespace {

struct UsualBone {
  JointRole end;
  double share;  ///< of its length by proportions of stature
};

/// The geometric means that the fit of 2026-11-28 found on tracks like OpenPose's, seed 2: of nine
/// of CMU's training clips and eight of Bandai's training halves, which differ by 0.1 in the
/// logarithm, shoulders by 0.3.
constexpr std::array kUsualBones{
    UsualBone{JointRole::spine, 0.94},          UsualBone{JointRole::left_hip, 0.94},
    UsualBone{JointRole::right_hip, 0.94},      UsualBone{JointRole::chest, 0.65},
    UsualBone{JointRole::neck, 0.63},           UsualBone{JointRole::left_clavicle, 0.63},
    UsualBone{JointRole::right_clavicle, 0.63}, UsualBone{JointRole::head, 1.23},
    UsualBone{JointRole::left_shoulder, 0.75},  UsualBone{JointRole::right_shoulder, 0.75},
    UsualBone{JointRole::left_elbow, 0.835},    UsualBone{JointRole::right_elbow, 0.835},
    UsualBone{JointRole::left_wrist, 0.835},    UsualBone{JointRole::right_wrist, 0.835},
    UsualBone{JointRole::left_knee, 0.96},      UsualBone{JointRole::right_knee, 0.96},
    UsualBone{JointRole::left_ankle, 1.04},     UsualBone{JointRole::right_ankle, 1.04}};

}  // namespace

Skeleton usual_body(Skeleton humanoid) {
  const SkeletonRoles& roles = humanoid_roles();
  for (const UsualBone& bone : kUsualBones) {
    const std::string& name =
        canonical_humanoid().joints[static_cast<std::size_t>(roles.joint(bone.end))].name;
    humanoid.joints[static_cast<std::size_t>(humanoid.find(name))].offset *= bone.share;
  }
  return humanoid;
}

Skeleton body_to_begin_with(const KnownOfClip& known, const Modalities& modalities) {
  if (known.skeleton) return *known.skeleton;
  const Skeleton& own = modalities.pose_features.skeleton();
  return known.detected && is_humanoid(own) ? usual_body(own) : own;
}

}  // namespace mcdbn
