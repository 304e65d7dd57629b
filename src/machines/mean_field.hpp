#pragma once

#include <span>

#include "machines/unit_kinds.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// The two halves of a mean-field step of an MRBM of which some modalities are absent, as products;
/// the fused kernels have them in one launch. What the units are (probabilities, draws, centered
/// ones) is the options' activation and sampling. Rows are given of every modality.
///
/// eq 32: the shared units from those of the modalities `from` and from `present_input`, which
/// present_input_of() makes; b alone, if no modality is apart from these.
/// @param units [rows x visible] of each modality  @param present_input, shared [rows x hidden]
inline void shared_units(const Mrbm& mrbm, std::span<const std::size_t> from,
                         std::span<const Rows> units, const Matrix& present_input,
                         GemmOptions options, const Rows& shared) {
  for (const std::size_t m : from.first(from.size() - 1)) {
    GemmOptions sum;
    sum.beta = options.beta;
    gemm(units[m], mrbm.W[m], shared, sum);
    options.beta = 1.0F;
  }
  options.bias = &present_input;
  gemm(units[from.back()], mrbm.W[from.back()], shared, options);
}

/// eq 33: the units of the absent modality m from the shared ones.
inline void absent_units(const Mrbm& mrbm, std::size_t m, const Rows& shared, GemmOptions options,
                         const Rows& absent) {
  options.bias = &mrbm.a[m];
  gemm(shared, mrbm.W_transposed[m], absent, options);
}

/// b and the present modalities' products: the shared units' input that is the same in every step.
/// @param present_input [rows x hidden]
inline void present_input_of(const Mrbm& mrbm, std::span<const std::size_t> present,
                             std::span<const Rows> units, const Rows& present_input) {
  GemmOptions options;
  options.bias = &mrbm.b;
  for (const std::size_t m : present) {
    gemm(units[m], mrbm.W[m], present_input, options);
    options.bias = nullptr;
    options.beta = 1.0F;
  }
}

}  // namespace mcdbn
