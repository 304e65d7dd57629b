#include "device/default_tuning.hpp"

#include <algorithm>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

Tuning cpu_tuning(unsigned register_floats) {
  // 32 registers of 16 floats.
  Tuning tuning{.largest_rows = 12,
                .update_rows = 8,
                .update_columns = 2,
                .product_columns = 2,
                .transposed_rows = 8,
                .transposed_columns = 2};
  if (register_floats >= 16) return tuning;
  // 16 registers: sums of one vector a row, beside the row's value and the weights.
  tuning.vector_width = register_floats >= 8 ? 8 : register_floats > 1 ? 4 : 1;
  tuning.accumulators = 12;
  tuning.update_columns = tuning.product_columns = tuning.transposed_columns = 1;
  return tuning;
}

Tuning for_units_of_8_floats(Tuning usual) {
  usual.largest_rows = 10;
  usual.accumulators = 20;
  return usual;
}

Tuning default_tuning(const DeviceInfo& info) {
  // Some drivers prefer single floats, which they join to vectors by themselves.
  if (!info.is_gpu)
    return cpu_tuning(std::max(info.preferred_vector_width, info.native_vector_width));
  // Neighbouring work-items take neighbouring floats. A mini-batch has few rows for so many compute
  // units: a row is shared by as many work-items as it can use, and each has many loads under way.
  return limited({.vector_width = 1,
                  .largest_rows = 8,
                  .accumulators = 1,
                  .group = 256,
                  .update_rows = 8,
                  .product_rows = 1,
                  .transposed_rows = 4,
                  .summed_rows = 0,
                  .unroll = 16,
                  .clblast_from = 8 << 20},
                 info);
}

}  // namespace mcdbn
