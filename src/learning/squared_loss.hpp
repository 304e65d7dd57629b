#pragma once

#include "mcdbn/learning/sequence_loss.hpp"

namespace mcdbn {

/// The mean squared error of a modality's standardized features.
class SquaredLoss : public SequenceLoss {
 public:
  /// @param seen like the target, 1 where it counts and 0 where it does not, read at each call; it
  ///        must live on. The mean is over what counts. None: everything does.
  SquaredLoss(Device& device, const SequenceWindows& windows, double weight,
              const Matrix* seen = nullptr);
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) override;
  double read_and_reset() override;
  void visit_state(TrainingState& state) override;

 private:
  SequenceWindows windows_;
  double weight_;
  const Matrix* seen_;
  Matrix losses_, sum_;
  Matrix seen_count_;  ///< [1 x dimension]
  std::size_t steps_ = 0;
};

/// @throws ShapeError unless each holds the windows' rows, all as wide
void require_windows(const SequenceWindows& windows, const Matrix& prediction, const Matrix& target,
                     const Matrix& error);

}  // namespace mcdbn
