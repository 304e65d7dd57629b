#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Seconds of the work that counts, on a device that has this tuning.
using TunedTime = std::function<double(const Tuning&)>;
/// Hears of each measurement.
using TuningNotice = std::function<void(const std::string&)>;

/// The fastest that one parameter changed after another leads to (tuning_candidates).
Tuning fastest_tuning(const DeviceInfo& info, const TunedTime& time_s,
                      const TuningNotice& notice = {});

/// The fewest multiply-adds from which CLBlast's product takes less time than ours and is right; 0
/// if it never does.
/// @param seconds for each measurement
std::int64_t clblast_threshold(Device& device, double seconds, const TuningNotice& notice = {});

/// Finds both, sets them on the device and stores them in the user's cache folder.
/// @param seconds for each measurement of a product
void tune(Device& device, const TunedTime& time_s, double seconds, const TuningNotice& notice = {});

}  // namespace mcdbn
