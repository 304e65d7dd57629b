#include "comparison/hold_last_frame.hpp"

#include <algorithm>

namespace mcdbn {

void HoldLastFrame::fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  first_frame_.fit(tracks, poses);
}

MatrixF HoldLastFrame::predict(const MatrixF& track) const {
  const Eigen::Index first = std::min<Eigen::Index>(1, track.rows());
  return first_frame_.predict(track.topRows(first)).replicate(track.rows(), 1);
}

}  // namespace mcdbn
