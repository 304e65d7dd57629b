#pragma once

#include "comparison/nearest_neighbour.hpp"

namespace mcdbn {

/// The last pose that is known before the clip runs, held throughout. As no ground truth is given,
/// that is the nearest neighbour's for the track's first frame.
class HoldLastFrame : public Baseline {
 public:
  std::string name() const override { return "hold_last_frame"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

 private:
  NearestNeighbour first_frame_;
};

}  // namespace mcdbn
