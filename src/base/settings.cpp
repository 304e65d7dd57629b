#include "mcdbn/base/settings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

bool Range::contains(double value) const {
  return std::isfinite(value) && (with_least ? value >= least : value > least) &&
         (with_most ? value <= most : value < most);
}

std::string Range::text() const {
  const std::string low = fmt::format("{} {}", with_least ? "at least" : "above", least),
                    high = fmt::format("{} {}", with_most ? "at most" : "below", most);
  if (std::isinf(least)) return std::isinf(most) ? "a finite number" : high;
  return std::isinf(most) ? low : low + " and " + high;
}

void check_range(const std::string& who, const Range& range, double value) {
  if (range.contains(value)) return;
  const std::string wanted = std::isinf(value) ? any_number().text() : range.text();
  throw ConfigError(fmt::format("{} must be {}, not {}", who, wanted, value));
}

}  // namespace mcdbn
