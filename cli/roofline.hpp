#pragma once

#include <nlohmann/json.hpp>

#include "device/kernel_rates.hpp"

namespace mcdbn::cli {

/// Each kernel of a step, and the time between launches, compared with the device's limits:
/// `peak_gflops`, and the bandwidth of reading as many bytes as the kernel again and again, which
/// is measured here. Kernels whose work is not counted have their time alone.
nlohmann::ordered_json roofline(Device& device, const StepTimes& times, double peak_gflops);

/// A line for each kernel.
void print_roofline(const nlohmann::ordered_json& roofline);

}  // namespace mcdbn::cli
