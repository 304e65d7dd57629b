#include "motion/interpolated_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace mcdbn {

RowVectorD interpolated_pose(const Skeleton& skeleton, const RowVectorD& from, const RowVectorD& to,
                             double part, const RowVectorD& previous) {
  RowVectorD pose = (1 - part) * from + part * to;
  Eigen::Index first = 0;
  for (const Joint& joint : skeleton.joints) {
    if (std::ranges::any_of(joint.channels, is_rotation)) {
      const Eigen::Quaterniond start(local_rotation(joint, from.data() + first)),
          end(local_rotation(joint, to.data() + first));
      set_local_rotation(joint, start.slerp(part, end).toRotationMatrix(), previous.data() + first,
                         pose.data() + first);
    }
    first += static_cast<Eigen::Index>(joint.channels.size());
  }
  return pose;
}

}  // namespace mcdbn
