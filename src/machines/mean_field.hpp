#pragma once

#include "device/gemm.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// The two halves of a mean-field step of an MRBM of which modality m is absent, as products; the
/// fused kernels have them in one launch. What the units are (probabilities, draws, centered ones)
/// is the options' activation and sampling.
///
/// eq 32: the shared units from the absent modality's and from `drive`, which is b and the present
/// modality's products. @param absent, shared [rows x units]  @param drive [rows x hidden]
inline void shared_units(const Mrbm& mrbm, std::size_t m, const Rows& absent, const Matrix& drive,
                         GemmOptions options, const Rows& shared) {
  options.bias = &drive;
  gemm(absent, mrbm.W[m], shared, options);
}

/// eq 33: the absent modality's units from the shared ones.
inline void absent_units(const Mrbm& mrbm, std::size_t m, const Rows& shared, GemmOptions options,
                         const Rows& absent) {
  options.bias = &mrbm.a[m];
  gemm(shared, mrbm.W_transposed[m], absent, options);
}

/// b and what the present modality m gives the shared units, the same in every step.
inline void drive_of(const Mrbm& mrbm, std::size_t m, const Rows& present, const Rows& drive) {
  GemmOptions bias;
  bias.bias = &mrbm.b;
  gemm(present, mrbm.W[m], drive, bias);
}

}  // namespace mcdbn
