#pragma once

#include <vector>

#include "mcdbn/model/modalities.hpp"
#include "mcdbn/training/joint_pass.hpp"

namespace mcdbn {

/// What the joint stage minimizes on the 3D modality, each a mean over what it counts.
struct PoseLossWeights {
  double features = 1.0;  ///< of squared standardized features
  double places = 0.0;    ///< of squared distances of joints from their places, in units of 5 cm
  double velocities =
      0.0;  ///< of squared differences of steps from frame to frame, in units of 1 cm
};

/// The loss on the 3D modality: features, and joint places and steps through forward kinematics of
/// the model's own skeleton (pose_loss.cl). The sums stay on the device.
class PoseLoss {
 public:
  static constexpr double kPlace_m = 0.05, kStep_m = 0.01;

  PoseLoss(Device& device, const Modalities& modalities, const JointWindows& windows,
           const PoseLossWeights& weights);
  /// Writes dL/d prediction, zero before the windows' lead. Both [windows.rows() x dimension] at
  /// least. Enqueues and returns. @throws ShapeError
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error);
  /// Means since the last call: features, places in units of 5 cm, steps in units of 1 cm, all
  /// squared. Waits for the queue. @return [1 x 3]
  std::vector<double> read_and_reset();

 private:
  JointWindows windows_;
  PoseLossWeights weights_;
  std::size_t dimension_, bones_ = 0;
  cl::Buffer bone_table_, levers_, columns_, scale_;
  Matrix differences_, losses_, sums_;
  std::size_t steps_ = 0;
};

/// The mean squared error of a modality's standardized features.
class FeatureLoss {
 public:
  FeatureLoss(Device& device, const JointWindows& windows, double weight);
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error);
  double read_and_reset();

 private:
  JointWindows windows_;
  double weight_;
  Matrix losses_, sum_;
  std::size_t steps_ = 0;
};

}  // namespace mcdbn
