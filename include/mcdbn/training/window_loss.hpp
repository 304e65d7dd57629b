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
  /// The same through the world, the root's travel included, of feet that are planted in truth.
  double contacts = 0.0;
  double planted_below_m_s = 0.4;  ///< a foot slower than this is planted, on a 1.7 m body
};

/// The loss on the 3D modality: features, and joint places and steps through forward kinematics of
/// the model's own skeleton, whose feet are known by their names (pose_loss.cl). The sums stay on
/// the device.
class PoseLoss {
 public:
  static constexpr double kPlace_m = 0.05, kStep_m = 0.01;

  PoseLoss(Device& device, const Modalities& modalities, const JointWindows& windows,
           const PoseLossWeights& weights);
  /// Writes dL/d prediction, zero before the windows' lead. Both [windows.rows() x dimension] at
  /// least. Enqueues and returns. @throws ShapeError
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error);
  /// The weighted loss, its mean since the last call. Waits for the queue.
  double read_and_reset();

 private:
  JointWindows windows_;
  PoseLossWeights weights_;
  std::size_t dimension_, bones_ = 0, feet_ = 0;
  int velocity_feature_ = 0;
  double frame_s_;
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
