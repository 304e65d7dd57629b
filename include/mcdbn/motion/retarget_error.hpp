#pragma once

#include <string>
#include <vector>

#include "mcdbn/motion/humanoid_rig.hpp"

namespace mcdbn {

/// Errors of a motion that goes to the humanoid and comes back.
struct RetargetError {
  struct OfJoint {
    std::string name;
    double mean_deg = 0, worst_deg = 0;  ///< of its orientation in the world
    double mean_mm = 0, worst_mm = 0;    ///< of its place, on a body 1.7 m tall
    double humanoid_mm = 0;              ///< mean, of its role's place on the humanoid
  };
  std::vector<OfJoint> joints;  ///< HumanoidRig::kept_joints
  double mean_deg() const;
  double mean_mm() const;
  double humanoid_mm() const;  ///< over all
  const OfJoint& worst_turned() const;
  const OfJoint& worst_placed() const;
};

/// In at most 200 frames spread over the clip.
RetargetError retarget_error(const HumanoidRig& rig, const Motion& motion);

}  // namespace mcdbn
