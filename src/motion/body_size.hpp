#pragma once

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Height of the person that a skeleton stands for, in file units, from its legs: thigh and shank
/// are 0.491 of a body's height (Drillis and Contini), and no two other bones that follow each
/// other are as long. So neither joint names nor an upright rest pose are needed, and the result is
/// right where the rest pose misleads (CMU rests with spread legs, Bandai with every bone along x).
/// A skeleton without two bones in a row counts as high as its rest pose is.
double body_height(const Skeleton& skeleton);

/// File units of `skeleton` in one metre of a body 1.7 m tall.
double file_units_per_metre(const Skeleton& skeleton);

}  // namespace mcdbn
