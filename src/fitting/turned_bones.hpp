#pragma once

#include <vector>

#include "fitting/lever.hpp"
#include "mcdbn/features/pose_features.hpp"

namespace mcdbn {

/// Whether an orientation is `other` or a descendant of it.
/// @param parents by orientation, the parent orientation, or −1
bool is_same_or_below(const std::vector<int>& parents, int turn, int other);

/// Which orientation of the features turns which bone of a skeleton. Orientations are global, so a
/// joint is the sum of the bones between the root and it, each turned on its own: a bone belongs to
/// the nearest joint at or above its upper end that has a feature.
class TurnedBones {
 public:
  /// @param joints of `skeleton` to lead bones to
  /// @throws InputError if the skeleton lacks a joint of the features
  TurnedBones(const PoseFeatures& features, const Skeleton& skeleton,
              const std::vector<int>& joints);

  int root() const { return root_; }
  /// By orientation, the parent orientation, or −1.
  const std::vector<int>& parents() const { return parents_; }
  /// By joint of the skeleton, the orientation that turns the bone to it, or −1.
  const std::vector<int>& turn_above() const { return turn_above_; }
  /// By joint, its levers as they lie in one pose.
  std::vector<std::vector<Lever>> levers(const WorldPose& pose,
                                         const Eigen::Matrix3d& camera_from_world) const;

 private:
  struct Bone {
    int turn, upper, lower;  ///< the orientation and the joints at both ends
  };
  int root_ = 0;
  std::vector<int> turn_above_;
  std::vector<int> parents_;
  std::vector<std::vector<Bone>> bones_of_joint_;  ///< from the joint up to the root
};

}  // namespace mcdbn
