#pragma once

#include <optional>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The motion with left and right exchanged, on the same skeleton: what a mirror beside the world's
/// x axis shows. Sides follow from joint names (opposite_joints). A joint's own axes are
/// reflected along one of them or along all three, whichever brings its bones onto those of the
/// other side. Where several do, one that does so for every joint is taken, else the one that makes
/// the joint's rotations in the mirror most like those of the motion. So rest poses with every bone
/// along one axis come out right too.
/// @return nothing where names show no sides or the two sides are built too differently
std::optional<Motion> mirrored(const Motion& motion);

/// For every joint the one on the other side by its name, itself in the middle; empty if the names
/// have no sides. The marks are those of other_side; where they give no pairs, single letters too
/// (possible_other_sides) between joints whose parents are the same or a pair: CMU's lfemur and
/// rfemur, Biped's `Bip01 L Thigh`, VRM's J_Bip_L_Hand.
std::vector<int> opposite_joints(const Skeleton& skeleton);

}  // namespace mcdbn
