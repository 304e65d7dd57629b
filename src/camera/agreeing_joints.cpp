#include "camera/agreeing_joints.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace mcdbn {
namespace {

// Chosen on 37 of CMU's training clips and 24 of Bandai's training halves, tracks like OpenPose's
// and MediaPipe's (docs/fit_settings.md).

/// A weight below it is unsure: 0.85 of the usual confidence.
constexpr double kSure = 0.67;
/// A joint so far from the answer's lies elsewhere, as a share of the person's extent in the image.
constexpr double kElsewhere = 0.03;

/// The larger side of the box around a frame's joints.
double extent_px(const Track2d& track, Eigen::Index frame) {
  const auto side = [&](const MatrixD& px) {
    return px.row(frame).maxCoeff() - px.row(frame).minCoeff();
  };
  return std::max(side(track.x_px), side(track.y_px));
}

}  // namespace

Track2d agreeing_joints(Track2d joints, const Track2d& answer) {
  std::vector<int> columns;
  for (const std::string& name : joints.joint_names) columns.push_back(answer.find(name));
  for (Eigen::Index t = 0; t < joints.frames(); ++t) {
    const double farthest_px = kElsewhere * extent_px(answer, t);
    for (Eigen::Index k = 0; k < joints.joint_count(); ++k) {
      const int column = columns[static_cast<std::size_t>(k)];
      if (column < 0 || !(joints.confidence(t, k) < kSure)) continue;
      const double away_px = std::hypot(joints.x_px(t, k) - answer.x_px(t, column),
                                        joints.y_px(t, k) - answer.y_px(t, column));
      if (away_px > farthest_px) joints.confidence(t, k) = 0;
    }
  }
  return joints;
}

}  // namespace mcdbn
