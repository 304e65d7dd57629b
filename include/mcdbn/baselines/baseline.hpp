#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mcdbn/matrix_types.hpp"

namespace mcdbn {

/// A way to get the 3D modality from the 2D one that the model has to beat. All of them see the
/// same standardized features as the model: [frames x dimension], one matrix a clip.
class Baseline {
 public:
  virtual ~Baseline() = default;
  virtual std::string name() const = 0;  ///< as in reports: mean_pose, nearest_neighbour, …
  virtual void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) = 0;
  virtual MatrixF predict(const MatrixF& track) const = 0;
};

}  // namespace mcdbn
