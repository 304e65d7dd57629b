#pragma once

#include "mcdbn/features/modalities.hpp"
#include "mcdbn/learning/sequence_loss.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// The loss on the 3D modality: features, and joint positions and steps through forward kinematics
/// of the model's own skeleton, whose feet are known by their names (kinematic_loss.cl). The sums
/// stay on the device.
class PoseLoss : public SequenceLoss {
 public:
  static constexpr double kPosition_m = 0.05, kStep_m = 0.01;

  PoseLoss(Device& device, const Modalities& modalities, const SequenceWindows& windows,
           const PoseLossWeights& weights);
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) override;
  double read_and_reset() override;
  void visit_state(TrainingState& state) override;

 private:
  SequenceWindows windows_;
  PoseLossWeights weights_;
  std::size_t dimension_, bones_ = 0, feet_ = 0;
  int velocity_feature_ = 0;
  double frame_s_;
  cl::Buffer bone_table_, levers_, columns_, scale_;
  Matrix differences_, losses_, sums_;
  std::size_t steps_ = 0;
};

}  // namespace mcdbn
