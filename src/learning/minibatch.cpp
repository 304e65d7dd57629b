#include "learning/minibatch.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

MinibatchSchedule::MinibatchSchedule(Device& device, std::vector<std::int32_t> rows,
                                     std::size_t batch, std::size_t least_batches,
                                     const std::vector<double>& weights)
    : device_(&device), ends_(weights.size()), batch_(std::min(batch, rows.size())) {
  if (rows.empty() || batch_ == 0)
    throw ShapeError("mini-batches: no clip is longer than the history");
  do {
    rows_.insert(rows_.end(), rows.begin(), rows.end());
  } while (batch_count() < least_batches);
  std::partial_sum(weights.begin(), weights.end(), ends_.begin());
  choices_ = std::move(rows);
  index_ = IndexBuffer(device, rows_);
}

/// Systematic sampling: a row comes as often as its share of them all, rounded up or down.
void MinibatchSchedule::draw(float uniform) {
  const double step = ends_.back() / static_cast<double>(rows_.size());
  std::size_t choice = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double at = (static_cast<double>(i) + static_cast<double>(uniform)) * step;
    while (ends_[choice] <= at && choice + 1 < choices_.size()) ++choice;
    rows_[i] = choices_[choice];
  }
}

void MinibatchSchedule::shuffle(const RandomKey& key) {
  if (!ends_.empty()) draw(random_uniform(key, 0, 1));
  // Fisher-Yates on Philox: std::shuffle differs between standard libraries.
  for (std::size_t i = rows_.size() - 1; i > 0; --i) {
    const std::uint64_t bits = random_bits(key, static_cast<std::uint32_t>(i), 0);
    std::swap(rows_[i], rows_[(bits * (i + 1)) >> 32]);
  }
  index_.upload(*device_, rows_);
}

}  // namespace mcdbn
