#pragma once

#include <fmt/format.h>

#include <string>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

/// @throws ConfigError unless value > 0
template <typename Value>
void require_positive(const std::string& name, Value value) {
  if (!(value > 0)) throw ConfigError(fmt::format("{} must be above 0, not {}", name, value));
}

/// @throws ConfigError unless 0 ≤ value < 1
inline void require_share(const std::string& name, double value) {
  if (!(value >= 0 && value < 1))
    throw ConfigError(fmt::format("{} must be at least 0 and below 1, not {}", name, value));
}

}  // namespace mcdbn
