#pragma once

#include <string_view>

namespace mcdbn {

/// OpenBLAS takes a CPU that is newer than itself for a Pentium 4. Where it has, it gets the
/// kernels of the CPU with AVX-512, or else AVX2, that it does know. Nothing changes with another
/// BLAS, or where OPENBLAS_CORETYPE is set. No other thread may call BLAS meanwhile, so this is for
/// a program's first lines.
void choose_blas_kernels();

/// @return the newest of the CPUs known to OpenBLAS that this one can stand in for, or nothing
std::string_view known_cpu_like_this();

}  // namespace mcdbn
