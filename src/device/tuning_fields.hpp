#pragma once

#include <array>
#include <string_view>

#include "mcdbn/device/tuning.hpp"

namespace mcdbn {

struct TuningField {
  std::string_view name;
  int Tuning::*value;
};

/// All of a Tuning but clblast_from.
inline constexpr std::array kTuningFields{
    TuningField{"vector_width", &Tuning::vector_width},
    TuningField{"largest_rows", &Tuning::largest_rows},
    TuningField{"accumulators", &Tuning::accumulators},
    TuningField{"group", &Tuning::group},
    TuningField{"update_rows", &Tuning::update_rows},
    TuningField{"update_columns", &Tuning::update_columns},
    TuningField{"product_rows", &Tuning::product_rows},
    TuningField{"product_columns", &Tuning::product_columns},
    TuningField{"transposed_rows", &Tuning::transposed_rows},
    TuningField{"transposed_columns", &Tuning::transposed_columns},
    TuningField{"summed_rows", &Tuning::summed_rows},
    TuningField{"unroll", &Tuning::unroll}};

}  // namespace mcdbn
