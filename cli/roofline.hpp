#pragma once

#include <nlohmann/json.hpp>

#include "device/kernel_rates.hpp"

namespace mcdbn::cli {

/// Each kernel of a step, and the time between launches, against what the device could do: it
/// multiplies no faster than `peak_gflops`, and reads what the kernel touches no faster than so
/// many bytes can be read again and again, which is measured here. Kernels whose work nobody
/// counted have their time alone.
nlohmann::ordered_json roofline(Device& device, const StepTimes& times, double peak_gflops);

/// A line for each kernel.
void print_roofline(const nlohmann::ordered_json& roofline);

}  // namespace mcdbn::cli
