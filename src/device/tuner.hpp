#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Seconds of the work that counts, on a device that has this tuning.
using TunedTime = std::function<double(const Tuning&)>;
/// The work that candidates are measured with. Mini-batches of CRBMs have no products, so their
/// time says nothing about the parameters of products.
struct TunedWork {
  TunedTime products_s;     ///< for a candidate that changes a parameter of products (gemm.cl)
  TunedTime minibatches_s;  ///< for all others
};
/// Hears of each measurement.
using TuningNotice = std::function<void(const std::string&)>;

/// Where a tuner begins: the default, for units as wide as they are measured to be.
Tuning tuning_for_units(Device& device, const TuningNotice& notice = {});

/// The fastest that one parameter changed after another leads to from `usual` (tuning_candidates).
Tuning fastest_tuning(const DeviceInfo& info, const Tuning& usual, const TunedWork& work,
                      const TuningNotice& notice = {});

/// The fewest multiply-adds from which CLBlast's product takes less time than ours and is right; 0
/// if it never does, or the device refuses CLBlast's work.
/// @param seconds for each measurement
std::int64_t clblast_threshold(Device& device, double seconds, const TuningNotice& notice = {});

/// Finds both, sets them on the device and stores them in the user's cache folder.
/// @param usual where to begin  @param seconds for each measurement by clblast_threshold
/// @return whether they could be stored
bool tune(Device& device, const Tuning& usual, const TunedWork& work, double seconds,
          const TuningNotice& notice = {});

}  // namespace mcdbn
