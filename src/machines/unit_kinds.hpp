#pragma once

#include "device/gemm.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// Activation that turns the inputs of units of that kind into their means.
inline Activation activation_of(VisibleKind kind) {
  return kind == VisibleKind::binary ? Activation::sigmoid : Activation::none;
}

/// How units of that kind are drawn from their mean.
inline Sampling sampling_of(VisibleKind kind) {
  return kind == VisibleKind::binary ? Sampling::bernoulli : Sampling::gaussian;
}

/// The mean of units of that kind, as an epilogue.
inline GemmOptions mean_of_units(VisibleKind kind) {
  GemmOptions options;
  options.activation = activation_of(kind);
  return options;
}

}  // namespace mcdbn
