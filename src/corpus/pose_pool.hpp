#pragma once

#include <array>
#include <memory>
#include <vector>

#include "corpus/clip_groups.hpp"
#include "mcdbn/corpus/clip_store.hpp"
#include "mcdbn/corpus/training_set.hpp"
#include "motion/humanoid_poses.hpp"
#include "motion/joint_limits.hpp"

namespace mcdbn {

/// Source of new poses of the humanoid: the clips of a corpus, and how far joints turn in them.
/// Left and right are taken together.
class PosePool {
 public:
  /// @param clips on the humanoid (load_training_clips)  @throws ConfigError if they are not
  /// @param people whose clips are taken
  PosePool(ClipStore clips, double fps, const PeopleChoice& people = {});

  std::size_t clips() const { return taken_.size(); }
  /// A piece of a clip at the pool's rate: from some share of it on, and back again where it ends.
  /// @param from 0 to 1
  HumanoidPoses piece(std::size_t clip, double from, int frames) const;
  const JointLimits& limits(JointRole role) const {
    return limits_[static_cast<std::size_t>(role)];
  }

 private:
  ClipStore clips_;
  std::vector<std::size_t> taken_;  ///< of those clips
  double fps_;
  std::array<JointLimits, kJointRoleCount> limits_;
};

/// Pool for new poses in views of those people's clips; null where the settings want none.
std::shared_ptr<const PosePool> pose_pool_for(const ClipStore& clips,
                                              const CorpusSettings& settings,
                                              const PeopleChoice& people = {});

}  // namespace mcdbn
