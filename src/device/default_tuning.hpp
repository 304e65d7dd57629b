#pragma once

#include "mcdbn/device/tuning.hpp"

namespace mcdbn {

/// What suits a CPU, of a small table.
/// @param register_floats floats of a vector register, 1 without vectors
Tuning cpu_tuning(unsigned register_floats);

/// `usual` for a CPU whose registers hold 16 floats, but whose units take them in two passes
/// (has_units_of_16_floats): half as many sums hide an fma()'s latency, and 10 rows load less.
Tuning for_units_of_8_floats(Tuning usual);

}  // namespace mcdbn
