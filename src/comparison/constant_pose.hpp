#pragma once

#include "comparison/baseline.hpp"

namespace mcdbn {

/// The mean of all training poses, whatever the track shows.
class ConstantPose : public Baseline {
 public:
  std::string name() const override { return "mean_pose"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

 private:
  Eigen::Index track_dimension_ = 0;
  RowVectorF mean_;  ///< [1 x d3]
};

}  // namespace mcdbn
