#pragma once

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Single-precision GFLOP/s of a loop of independent fma(): what any kernel could reach at most on
/// this device now. Every compute unit has many work-groups to take, so that one that wakes up late
/// takes fewer, and the best of several medians counts. Waits for the queue.
double measure_peak_gflops(Device& device);

/// GB/s at which all compute units together read `bytes` again and again: those of the memory where
/// so many stay, a cache or the main one. Waits for the queue.
double measure_read_gbytes_per_s(Device& device, std::size_t bytes);

}  // namespace mcdbn
