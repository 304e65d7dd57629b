#include "reference/loss_error_bound.hpp"

namespace mcdbn::reference {

Bounded squared_error(const Bounded& x, const Bounded& y) {
  const Bounded difference = x - y;
  return total(times(difference, difference));
}

Bounded cross_entropy(const Bounded& target, const Bounded& prediction) {
  const Bounded p = clamped(prediction, double{1e-7F}, double{1.0F - 1e-7F});
  return -total(times(target, logarithm(p)) + times(one_minus(target), logarithm(one_minus(p))));
}

}  // namespace mcdbn::reference
