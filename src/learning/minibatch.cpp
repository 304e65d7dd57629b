#include "learning/minibatch.hpp"

#include <algorithm>
#include <utility>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

MinibatchSchedule::MinibatchSchedule(Device& device, const std::vector<std::int32_t>& rows,
                                     std::size_t batch, std::size_t least_batches)
    : device_(&device), batch_(std::min(batch, rows.size())) {
  if (rows.empty() || batch_ == 0)
    throw ShapeError("mini-batches: no clip is longer than the history");
  do {
    rows_.insert(rows_.end(), rows.begin(), rows.end());
  } while (batch_count() < least_batches);
  index_ = IndexBuffer(device, rows_);
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
