#pragma once

#include "corpus/pose_pool.hpp"
#include "mcdbn/corpus/augmentation.hpp"

namespace mcdbn {

/// The motion with poses that no clip holds, each change in its own share of the views: limbs of
/// other clips, limbs turned at random, arms anywhere, leaning, turning round. Bones keep their
/// lengths, the lowest foot its height. A key always gives the same motion.
/// @param motion of the humanoid, at the pool's rate
Motion with_new_poses(const Motion& motion, const AugmentationSettings& settings,
                      const PosePool& pool, const RandomKey& key);

// The changes themselves, for tests.

/// The legs of `poses`, the upper body of one other clip and an arm of another. The upper body
/// stands in the world as it did there, turned about the vertical so that both pelvises head alike.
void exchange_limbs(HumanoidPoses& poses, const PosePool& pool, std::uint64_t seed);
/// Every joint but the pelvis is turned by a smooth random rotation, those of trunk and neck by
/// half of it, not beyond the pool's limits.
void turn_limbs(HumanoidPoses& poses, const PosePool& pool, double deviation_deg,
                std::uint64_t seed);
/// Upper arms point anywhere but far behind the body or across it, elbows bend at random.
void put_arms_anywhere(HumanoidPoses& poses, std::uint64_t seed);
/// All above the hips leans by a smooth random turn about level axes; the legs stand as they did.
void lean(HumanoidPoses& poses, double deviation_deg, std::uint64_t seed);
/// The body turns about the vertical, its path with it.
void turn_round(HumanoidPoses& poses, std::uint64_t seed);

/// The direction in which the pelvis looks, as a rotation about the vertical.
Eigen::Matrix3d heading_of(const Eigen::Matrix3d& world_from_pelvis);

}  // namespace mcdbn
