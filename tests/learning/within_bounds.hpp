#pragma once

// Machines on the device against the reference's, every parameter within its bound.

#include <doctest/doctest.h>

#include "machines/in_double.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "reference/crbm_error_bound.hpp"
#include "reference/error_bounds.hpp"
#include "reference/mrbm_error_bound.hpp"

namespace mcdbn::test {

inline reference::Mrbm in_double(const MrbmParameters& p) {
  reference::Mrbm mrbm;
  for (std::size_t m = 0; m < p.W.size(); ++m) {
    mrbm.weights.push_back(p.W[m].cast<double>());
    mrbm.visible_bias.push_back(p.a[m].cast<double>());
    mrbm.gaussian.push_back(p.shape.modalities[m].kind == VisibleKind::gaussian);
  }
  mrbm.hidden_bias = p.b.cast<double>();
  return mrbm;
}

inline void check_close(const char* name, const MatrixF& got, const MatrixD& want,
                        double tolerance) {
  INFO("parameter ", std::string(name));
  CHECK(reference::misfit(got, want, MatrixD::Constant(want.rows(), want.cols(), tolerance)) == "");
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
  REQUIRE(got.W.size() == want.weights.size());
  for (std::size_t m = 0; m < got.W.size(); ++m) {
    check_within(("W of modality " + std::to_string(m)).c_str(), got.W[m], want.weights[m]);
    check_within(("a of modality " + std::to_string(m)).c_str(), got.a[m], want.visible_bias[m]);
  }
  check_within("b", got.b, want.hidden_bias);
}

}  // namespace mcdbn::test
