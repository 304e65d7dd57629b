#pragma once

#include <utility>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Prior of the poses of a clip, before its track is looked at: a normal distribution for each
/// frame and feature. It is all that the fit knows of a network. Standardized 3D features, [frames
/// x Modalities::pose_scale.output_dimension()] both.
struct PosePrior {
  MatrixF mean;
  /// Standard deviation, finite and not negative; 0 x 0: not known, and the settings' typical
  /// ones are taken. Deviations of height and the root's position are not used.
  MatrixF deviation;

  PosePrior() = default;
  /// A mean alone, without a deviation, where a method answers poses and no more.
  PosePrior(MatrixF mean_, MatrixF deviation_ = {})  // NOLINT(google-explicit-constructor)
      : mean(std::move(mean_)), deviation(std::move(deviation_)) {}
  bool has_deviation() const { return deviation.size() > 0; }
};

}  // namespace mcdbn
