#pragma once

#include "comparison/baseline.hpp"

namespace mcdbn {

/// The pose of the training frame whose 2D features are nearest (Euclidean); the earliest such
/// frame wins ties. Exact: single-precision products only preselect, what they cannot separate
/// is compared in double.
class NearestNeighbour : public Baseline {
 public:
  std::string name() const override { return "nearest_neighbour"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

  /// Row, among all training frames in their order, that each frame of the track takes.
  std::vector<Eigen::Index> nearest_rows(const MatrixF& track) const;

 private:
  MatrixF tracks_, poses_;        ///< [all training frames x d2], [… x d3]
  Eigen::VectorXf half_squares_;  ///< [all training frames], ½‖track‖²
};

}  // namespace mcdbn
