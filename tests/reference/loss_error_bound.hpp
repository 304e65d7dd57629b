#pragma once

#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// Σ (x − y)² over all entries. [1 x 1]
Bounded squared_error(const Bounded& x, const Bounded& y);

/// Σ − t·log p − (1 − t)·log(1 − p) over all entries, p kept away from 0 and 1 as the device does
/// it. [1 x 1]
Bounded cross_entropy(const Bounded& target, const Bounded& prediction);

}  // namespace mcdbn::reference
