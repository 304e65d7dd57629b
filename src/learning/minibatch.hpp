#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/base/random.hpp"
#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

/// The order in which an epoch visits the windows: "each of N + 1 frames are mixed into a
/// mini-batch" (section IV.B). Whole batches only; what is left over differs from epoch to epoch.
/// With fewer rows than a batch all of them make one batch; with fewer batches than `least_batches`
/// every row comes several times. Rows that weigh more than others come as many times as often, an
/// epoch as many rows as without weights.
class MinibatchSchedule {
 public:
  /// @param rows frame numbers that have a history within their clip  @throws ShapeError if none
  /// @param weights of the rows; none: all alike
  MinibatchSchedule(Device& device, std::vector<std::int32_t> rows, std::size_t batch,
                    std::size_t least_batches = 1, const std::vector<double>& weights = {});

  /// Shuffles anew, by the key, and uploads. With weights it draws anew which rows come.
  void shuffle(const RandomKey& key);
  std::size_t batch() const { return batch_; }
  std::size_t batch_count() const { return rows_.size() / batch_; }
  const IndexBuffer& index() const { return index_; }
  std::size_t first_of(std::size_t batch_number) const { return batch_number * batch_; }

 private:
  void draw(float uniform);

  Device* device_;
  std::vector<std::int32_t> choices_;  ///< the rows, where they have weights
  std::vector<double> ends_;           ///< of each row's share in the draw, added up
  std::vector<std::int32_t> rows_;
  std::size_t batch_;
  IndexBuffer index_;
};

}  // namespace mcdbn
