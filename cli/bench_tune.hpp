#pragma once

#include "mcdbn/device/device.hpp"

namespace mcdbn::cli {

/// Finds the Tuning that makes mini-batches fastest on the device, one parameter after another, and
/// from which size on CLBlast's products, if they are right, beat ours. The winners are set on the
/// device and stored in the user's cache folder.
/// @param seconds for each measurement
void tune(Device& device, double seconds);

}  // namespace mcdbn::cli
