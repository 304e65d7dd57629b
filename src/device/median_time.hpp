#pragma once

#include <functional>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Median seconds of a run, measured for about `seconds`; runs are enqueued one after another, as
/// an epoch does; five samples at least, or the seconds of a single run if `seconds` is 0. Run it
/// once before, so that programs are built.
double median_time_s(Device& device, const std::function<void()>& run, double seconds);

}  // namespace mcdbn
