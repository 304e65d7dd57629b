#pragma once

#include <cstdint>
#include <functional>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Bones longer or shorter, alike on both sides where the skeleton has sides. Longer legs stand
/// higher and take longer steps.
/// @param factor of the bone that ends at this joint; of a pair only the first is asked
void scale_bones(Motion& motion, const std::function<double(int joint)>& factor);

/// How much people differ from the one who was captured: relative deviations.
struct OtherBody {
  double height = 0.05;       ///< of all bones together
  double proportions = 0.05;  ///< of each bone
};

/// The same motion by somebody else. The same seed makes the same person.
Motion with_other_body(Motion motion, const OtherBody& deviations, std::uint64_t seed);

}  // namespace mcdbn
