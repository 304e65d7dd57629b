#pragma once

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Single-precision GFLOP/s of a loop of independent fma(), the best of several runs of some
/// milliseconds: what any kernel could reach at most on this device now. Waits for the queue.
double measure_peak_gflops(Device& device);

}  // namespace mcdbn
