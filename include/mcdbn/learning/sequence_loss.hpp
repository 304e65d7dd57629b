#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

class TrainingState;

/// Windows of a mini-batch: `count` of `frames` frames, one after another. Frames before `first`
/// are history, those from there to `judged_from` settle, the rest are judged.
struct SequenceWindows {
  std::size_t count = 0, frames = 0, first = 0, judged_from = 0;
  std::size_t rows() const { return count * frames; }
};

/// The loss that fine-tuning minimizes: an error of the frames that a network predicted for a
/// mini-batch of windows, summed up on the device until it is asked for.
class SequenceLoss {
 public:
  virtual ~SequenceLoss() = default;
  /// Writes dL/d prediction, zero before `judged_from`. Each is [at least windows.rows() x
  /// dimension]. Enqueues and returns. @throws ShapeError
  virtual void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) = 0;
  /// The weighted loss, its mean since the last call. Waits for the queue.
  virtual double read_and_reset() = 0;
  /// What a checkpoint has to keep of the loss: sums that were not read yet. A loss without sums
  /// needs none.
  virtual void visit_state(TrainingState& /*state*/) {}
};

/// Makes a loss for windows of that shape.
using SequenceLossMaker =
    std::function<std::unique_ptr<SequenceLoss>(Device& device, const SequenceWindows& windows)>;

}  // namespace mcdbn
