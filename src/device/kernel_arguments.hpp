#pragma once

#include "device/gemm.hpp"
#include "device/launch.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

/// Floats that one work-item takes at once.
inline int vector_width(const Device& device) {
  return device.tuning().vector_width;
}

inline std::size_t ceil_divide(std::size_t value, std::size_t by) {
  return (value + by - 1) / by;
}

inline int to_int(std::size_t value) {
  return static_cast<int>(value);
}

inline cl_uint4 random_argument(const RandomKey& key) {
  return {{static_cast<cl_uint>(key.seed), static_cast<cl_uint>(key.seed >> 32), key.step,
           (static_cast<cl_uint>(key.stream) << 16) | key.phase}};
}

inline void require(bool holds, const char* what) {
  if (!holds) throw ShapeError(what);
}

inline bool same_shape(const Rows& x, const Rows& y) {
  return x.count == y.count && x.columns == y.columns;
}

}  // namespace mcdbn
