#pragma once

#include "comparison/baseline.hpp"

namespace mcdbn {

/// Ridge regression from a window of 2D frames (track_window.hpp) to the pose, with a bias that is
/// not penalised. The penalty is chosen by five-fold cross-validation over whole clips.
class RidgeWindow : public Baseline {
 public:
  std::string name() const override { return "ridge_window"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

  /// The penalty a training frame, on squared coefficients.
  double penalty() const { return penalty_; }
  /// [kWindowFrames·d2 + 1 x d3], earliest frame first, the bias last.
  const MatrixD& coefficients() const { return coefficients_; }

 private:
  double penalty_ = 0;
  MatrixD coefficients_;
};

}  // namespace mcdbn
