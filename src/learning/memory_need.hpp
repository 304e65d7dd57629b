#pragma once

#include <algorithm>
#include <span>

#include "mcdbn/device/device.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/learning/sequence_source.hpp"

namespace mcdbn {

/// Least device memory that training takes, in bytes, by purpose.
struct MemoryNeed {
  double parameters = 0;  ///< and what optimizers keep of each
  double windows = 0;     ///< what a mini-batch leaves behind for its gradient
  double frames = 0;      ///< the data and their codes, which the greedy stages learn from

  double total() const { return parameters + windows + frames; }
  double largest() const { return std::max({parameters, windows, frames}); }
};

/// Of the whole training.
/// @param dimensions of each modality's frames  @param frames of all clips or views together
MemoryNeed memory_need(std::span<const std::size_t> dimensions, double frames,
                       const LearningSettings& settings);

/// Of the largest single buffer for each purpose, with the same parameters.
MemoryNeed largest_buffers(std::span<const std::size_t> dimensions, double frames,
                           const LearningSettings& settings);

/// Compares both with what the device has, before anything is asked for.
/// @throws ConfigError with the sizes and what to lower
void check_memory(std::span<const std::size_t> dimensions, double frames,
                  const LearningSettings& settings, const DeviceInfo& device);

/// The greedy stages need a window of frames: the history of every layer and the look-ahead.
/// @param longest frames of the longest clip
/// @throws ConfigError that names both and what to lower
void check_window(std::size_t longest, const LearningSettings& settings);

}  // namespace mcdbn
