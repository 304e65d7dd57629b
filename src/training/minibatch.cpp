#include "mcdbn/training/minibatch.hpp"

#include <algorithm>
#include <utility>

#include "mcdbn/errors.hpp"

namespace mcdbn {

MinibatchSchedule::MinibatchSchedule(Device& device, std::vector<std::int32_t> rows,
                                     std::size_t batch)
    : device_(&device),
      rows_(std::move(rows)),
      batch_(std::min(batch, rows_.size())),
      index_(device, rows_) {
  if (rows_.empty() || batch_ == 0)
    throw ShapeError("mini-batches: no clip is longer than the history");
}

void MinibatchSchedule::shuffle(const RandomKey& key) {
  // Fisher-Yates on Philox: std::shuffle differs between standard libraries.
  for (std::size_t i = rows_.size() - 1; i > 0; --i) {
    const std::uint64_t bits = random_bits(key, static_cast<std::uint32_t>(i), 0);
    std::swap(rows_[i], rows_[(bits * (i + 1)) >> 32]);
  }
  index_.upload(*device_, rows_);
}

}  // namespace mcdbn
