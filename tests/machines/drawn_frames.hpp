#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "reference/error_bounds.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::test {

/// Checks the frames in which no draw lies so near that rounding may decide it.
/// @return their share of all
inline double check_drawn(const std::vector<MatrixF>& got,
                          const std::vector<reference::Bounded>& want) {
  REQUIRE(got.size() == want.size());
  std::size_t checked = 0, rows = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    REQUIRE(got[i].rows() == want[i].value.rows());
    for (Eigen::Index t = 0; t < got[i].rows(); ++t, ++rows) {
      if (!(want[i].bound.row(t).maxCoeff() < 1e-3)) continue;
      ++checked;
      CAPTURE(i);
      CAPTURE(t);
      CHECK(reference::misfit(got[i].row(t), want[i].value.row(t), want[i].bound.row(t)) == "");
    }
  }
  return static_cast<double>(checked) / static_cast<double>(rows);
}

}  // namespace mcdbn::test
