#pragma once

// Machines on the device against what the reference says of them, every parameter within its bound.

#include <doctest/doctest.h>

#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "reference/crbm_error_bound.hpp"
#include "reference/error_bounds.hpp"
#include "reference/mrbm_error_bound.hpp"

namespace mcdbn::test {

inline reference::Crbm in_double(const CrbmParameters& p) {
  return {p.shape.kind == VisibleKind::gaussian ? reference::VisibleUnits::gaussian
                                                : reference::VisibleUnits::binary,
          p.W.cast<double>(),
          p.A.cast<double>(),
          p.B.cast<double>(),
          p.a.cast<double>(),
          p.b.cast<double>()};
}

inline reference::Mrbm in_double(const MrbmParameters& p) {
  return {{p.W[0].cast<double>(), p.W[1].cast<double>()},
          {p.a[0].cast<double>(), p.a[1].cast<double>()},
          p.b.cast<double>()};
}

inline void check_within(const char* name, const MatrixF& got, const reference::Bounded& want) {
  INFO(std::string(name));
  CHECK(reference::misfit(got, want.value, want.bound) == "");
}

inline void check_within(const char* name, float got, const reference::Bounded& want) {
  check_within(name, MatrixF::Constant(1, 1, got), want);
}

inline void check_within(const CrbmParameters& got, const reference::BoundedCrbm& want) {
  check_within("W", got.W, want.W);
  check_within("A", got.A, want.A);
  check_within("B", got.B, want.B);
  check_within("a", got.a, want.a);
  check_within("b", got.b, want.b);
}

inline void check_within(const MrbmParameters& got, const reference::BoundedMrbm& want) {
  check_within("W of the track", got.W[0], want.weights[0]);
  check_within("W of the pose", got.W[1], want.weights[1]);
  check_within("a of the track", got.a[0], want.visible_bias[0]);
  check_within("a of the pose", got.a[1], want.visible_bias[1]);
  check_within("b", got.b, want.hidden_bias);
}

}  // namespace mcdbn::test
