#include "comparison/track_window.hpp"

#include <algorithm>

#include "base/missing_values.hpp"
#include "comparison/clip_pairs.hpp"

namespace mcdbn {

MatrixF track_windows(const MatrixF& track, Eigen::Index first, Eigen::Index count) {
  const Eigen::Index d2 = track.cols();
  MatrixF rows(count, kWindowFrames * d2);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k < kWindowFrames; ++k) {
      const Eigen::Index frame =
          std::clamp<Eigen::Index>(first + i + k - kWindowReach, 0, track.rows() - 1);
      rows.row(i).segment(k * d2, d2) = track.row(frame);
    }
  return rows;
}

MatrixF track_windows(const MatrixF& track) {
  return track_windows(at_mean_where_unknown(track), 0, track.rows());
}

WindowPairs window_pairs(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  check_clip_pairs(tracks, poses);
  std::vector<MatrixF> windows;
  windows.reserve(tracks.size());
  for (const MatrixF& track : tracks) windows.push_back(track_windows(track));
  return {stacked(windows), stacked(poses)};
}

}  // namespace mcdbn
