#include "mcdbn/camera/track_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/upper_median.hpp"

namespace mcdbn {
namespace {

double jitter(const Track2d& track) {
  std::vector<double> differences;
  for (const MatrixD* axis : {&track.x_px, &track.y_px})
    for (Eigen::Index joint = 0; joint < axis->cols(); ++joint)
      for (Eigen::Index frame = 1; frame + 1 < axis->rows(); ++frame) {
        const double second =
            (*axis)(frame - 1, joint) - 2 * (*axis)(frame, joint) + (*axis)(frame + 1, joint);
        if (!std::isnan(second)) differences.push_back(std::abs(second));
      }
  if (differences.empty()) return std::numeric_limits<double>::quiet_NaN();
  // The median of |z| of a normal z is 0.6745; 1² + 2² + 1² = 6 independent deviations add up.
  return upper_median(std::move(differences)) / 0.6745 / std::sqrt(6.0);
}

}  // namespace

TrackSummary summarize(const Track2d& track) {
  TrackSummary summary;
  summary.frames = track.frames();
  const auto seen = (track.confidence.array() > 0).eval();
  summary.missing_joints = static_cast<long long>(seen.size()) - seen.count();
  for (Eigen::Index joint = 0; joint < seen.cols(); ++joint)
    summary.joint_seen_share.push_back(seen.rows() == 0
                                           ? 0.0
                                           : static_cast<double>(seen.col(joint).count()) /
                                                 static_cast<double>(seen.rows()));
  std::vector<double> heights;
  for (int frame = 0; frame < track.frames(); ++frame) {
    if (!seen.row(frame).any()) continue;
    if (summary.last_frame >= 0)
      summary.longest_gap_frames =
          std::max(summary.longest_gap_frames, frame - summary.last_frame - 1);
    else
      summary.first_frame = frame;
    summary.last_frame = frame;
    ++summary.seen_frames;
    double top = std::numeric_limits<double>::infinity(), bottom = -top;
    for (Eigen::Index joint = 0; joint < seen.cols(); ++joint) {
      if (!seen(frame, joint)) continue;
      top = std::min(top, track.y_px(frame, joint));
      bottom = std::max(bottom, track.y_px(frame, joint));
    }
    heights.push_back(bottom - top);
  }
  summary.height_px = heights.empty() ? 0.0 : upper_median(std::move(heights));
  summary.jitter_px = jitter(track);
  return summary;
}

}  // namespace mcdbn
