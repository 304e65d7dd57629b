#pragma once

#include <vector>

#include "mcdbn/features/pose_features.hpp"

namespace mcdbn {

/// A joint's position as the 6D features give it: that of the joint it hangs on plus a lever that
/// turns with one block. As the blocks are orientations in the camera's frame and not those against
/// the parent, positions are sums of turned levers.
struct PoseBone {
  int parent = -1;  ///< index of the bone that it starts from, -1: the root
  int block = 0;    ///< which 6D block turns it
  Eigen::Vector3d lever_m{0, 0, 0};
  int joint = 0;  ///< at its end
};

/// The bones of the model's own skeleton below its root, parents first; joints that stand where
/// their parent stands are left out. Lengths are those of a 1.7 m body.
std::vector<PoseBone> pose_bones(const PoseFeatures& features);

}  // namespace mcdbn
