#pragma once

#include <cstdint>
#include <functional>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Bones longer or shorter, alike on both sides where the skeleton has sides. Longer legs stand
/// higher and take longer steps.
/// @param factor of the bone that ends at this joint; of a pair only the first's counts
void scale_bones(Motion& motion, const std::function<double(int joint)>& factor);

/// How much people differ from the one who was captured.
struct OtherBody {
  double height = 0.05;
  double proportions = 0.05;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"height", within(0, 1), "", "relative deviation of a person's height"},
          self.height);
    visit(Setting{"proportions", within(0, 1), "",
                  "relative deviation of each bone's length, both sides alike"},
          self.proportions);
  }
};

/// The motion as another person does it. A seed always makes the same person.
Motion with_other_body(Motion motion, const OtherBody& deviations, std::uint64_t seed);

}  // namespace mcdbn
