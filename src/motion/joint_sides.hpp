#pragma once

#include <string>
#include <vector>

namespace mcdbn {

enum class Side { left, middle, right };

/// Whose side a joint is on, by its name: Left or Right in it, in any case (LeftArm,
/// upper_right_leg); an L or R, large or small, at its end behind `_`, `.`, `-` or a space (arm.L,
/// Hand_R), or at its beginning before one of those or before a capitalized word (l_arm,
/// LHipJoint). A name all in capitals (RHIP) is in the middle here, as ROOT is.
Side side_of(const std::string& joint_name);

/// Names that may be the other side's where a letter alone marks it: an l or r, large or small,
/// that begins or ends a word becomes the other one (lfemur, armL, J_Bip_L_Hand, thigh.L.001). Most
/// words with such a letter have no side: check that there is such a joint, on the other side's
/// parent.
std::vector<std::string> possible_other_sides(const std::string& joint_name);

/// The name with the mark of its side exchanged for the other side's, case kept; empty if it has
/// none. RHIP becomes LHIP, so ROOT becomes LOOT: check that there is such a joint.
std::string other_side(const std::string& joint_name);

}  // namespace mcdbn
