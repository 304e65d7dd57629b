#pragma once

#include <vector>

#include "device/training_state.hpp"

namespace mcdbn {

/// Sums that stay on the device until they are asked for, so that an epoch never waits for the
/// host. Reductions have a fixed order: the same bits every time.
class LossAccumulator {
 public:
  LossAccumulator(Device& device, std::size_t slots, std::size_t largest_batch);
  /// slot += scale · Σ (factor · (x − y))²
  /// @param factor [1 x columns] of each column; none: 1, to the same bits  @throws ShapeError
  void add_squared_error(std::size_t slot, const Rows& x, const Rows& y, float scale,
                         const Matrix* factor = nullptr);
  /// slot += scale · Σ cross-entropy of prediction y against target x (both within 0 … 1)
  void add_cross_entropy(std::size_t slot, const Rows& x, const Rows& y, float scale);
  /// Where the sums lie, for kernels that add to them by themselves: slot s is float s.
  const cl::Buffer& buffer() const { return sums_.buffer(); }
  void visit_state(TrainingState& state) { state.matrix("losses", sums_); }
  /// Waits for the queue, returns the sums and starts again from zero.
  std::vector<float> read_and_reset();

 private:
  void add(const char* kernel, std::size_t slot, const Rows& x, const Rows& y, float scale,
           const Matrix* factor = nullptr);
  Matrix partial_, sums_;  ///< [1 x largest_batch], [1 x slots]
};

}  // namespace mcdbn
