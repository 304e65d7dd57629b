#pragma once

#include "mcdbn/learning/sequence_loss.hpp"

namespace mcdbn {

/// The mean squared error of a modality's standardized features.
class SquaredLoss : public SequenceLoss {
 public:
  SquaredLoss(Device& device, const SequenceWindows& windows, double weight);
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) override;
  double read_and_reset() override;

 private:
  SequenceWindows windows_;
  double weight_;
  Matrix losses_, sum_;
  std::size_t steps_ = 0;
};

/// @throws ShapeError unless each holds the windows' rows, all as wide
void require_windows(const SequenceWindows& windows, const Matrix& prediction, const Matrix& target,
                     const Matrix& error);

}  // namespace mcdbn
