#pragma once

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Single-precision GFLOP/s of a loop of independent fma(): what any kernel could reach at most on
/// this device now. Every compute unit has many work-groups to take, so that one that wakes up late
/// takes fewer; launches follow each other, and their best median counts. Waits for the queue.
double measure_peak_gflops(Device& device);
/// As measure_peak_gflops(device), with vectors of one width. @param vector_width 1, 4, 8 or 16
double measure_peak_gflops(Device& device, int vector_width);

/// Whether a core multiplies and adds 16 floats in one pass. Registers of 512 bits do not show
/// it: some cores take them in two.
bool has_units_of_16_floats(Device& device);

/// GB/s at which all compute units together read `bytes` again and again: those of the memory where
/// so many stay, a cache or the main one. Waits for the queue.
double measure_read_gbytes_per_s(Device& device, std::size_t bytes);

}  // namespace mcdbn
