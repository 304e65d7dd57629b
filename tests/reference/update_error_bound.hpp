#pragma once

#include "device/optimizer.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// momentum_update() and adam_update() with bounds on what single precision makes of them; what is
/// updated in place may carry errors from before.
void bounded_momentum_update(Bounded& parameter, Bounded& velocity, const Bounded& gradient,
                             const UpdateRule& rule);
void bounded_adam_update(Bounded& parameter, Bounded& mean, Bounded& square,
                         const Bounded& gradient, const UpdateRule& rule, int step);

}  // namespace mcdbn::reference
