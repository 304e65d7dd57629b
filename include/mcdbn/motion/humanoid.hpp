#pragma once

#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// The canonical humanoid, onto which skeletons of every make are brought: a joint for each role,
/// called by the role's name. At rest it stands in a T-pose: up is +y, it faces +z, its left is +x,
/// palms down, thumbs forward. The root is the pelvis, the only joint with position channels. It is
/// 170 units tall, so that one is a centimetre. Every joint turns about three axes, in an order in
/// which it turns least about the middle one (docs/joints.md).
///
/// Heights and lengths are shares of stature of Drillis and Contini (1966), as in Winter,
/// Biomechanics and Motor Control of Human Movement, fig. 4.1: hip 0.530, knee 0.285, ankle 0.039,
/// shoulder 0.818, half the shoulders' breadth 0.129, upper arm 0.186, forearm 0.146, hand 0.108,
/// foot 0.152. Hip centres are 0.100 apart (Bell et al. 1990, 17 cm of 170). The head turns at
/// 0.910 (McConville et al. 1980), the neck's base is the seventh cervical vertebra at 0.840. The
/// pelvis stands at the lumbosacral joint, 0.570, spine and chest at 0.620 and 0.720; the collar
/// bones begin 0.015 beside the middle. The ankle is a quarter of the foot's length before the
/// heel, the toe joint at 0.73 of it, knuckles are half a hand from the wrist.
const Skeleton& canonical_humanoid();

/// Whether the skeleton has the humanoid's joints, of whatever lengths, with its orders of axes or
/// with Z X Y, which all its joints had in older files and models.
bool is_humanoid(const Skeleton& skeleton);

/// The humanoid's motion with its orders of axes, angles continuous; any other comes back as it is.
Motion with_humanoid_orders(const Motion& motion);

/// Which of its joints plays which role: each plays one.
const SkeletonRoles& humanoid_roles();

}  // namespace mcdbn
