#pragma once

#include <doctest/doctest.h>

namespace mcdbn::test {

/// Equal but for less than a share of the larger one. doctest's Approx alone also allows that share
/// of 1, which is more than many a small number.
inline doctest::Approx near(double value, double share) {
  return doctest::Approx(value).epsilon(share).scale(0);
}

}  // namespace mcdbn::test
