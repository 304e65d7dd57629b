#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// A way to get the 3D modality from the 2D one that the model has to beat. All of them see the
/// same standardized features as the model: [frames x dimension], one matrix a clip. A NaN in a
/// track (a joint that was not seen) is taken as 0, the training mean.
class Baseline {
 public:
  virtual ~Baseline() = default;
  virtual std::string name() const = 0;  ///< as in reports: mean_pose, nearest_neighbour, …

  /// @param tracks, poses the 2D and 3D modality of each training clip, [frames x d2], [frames x
  /// d3]
  /// @throws ShapeError if they do not pair up or hold no frame at all
  virtual void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) = 0;

  /// @param track [frames x d2]  @return [frames x d3]
  /// @throws ShapeError if nothing was fitted, or d2 is another than in training
  virtual MatrixF predict(const MatrixF& track) const = 0;
};

/// One of each that needs no device, not fitted yet: mean_pose,
/// hold_last_frame, nearest_neighbour, ridge_window.
std::vector<std::unique_ptr<Baseline>> default_baselines();

}  // namespace mcdbn
