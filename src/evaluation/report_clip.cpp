#include "evaluation/report_clip.hpp"

namespace mcdbn {

MatrixD judged_positions(const ReportClip& clip, const MatrixD& points_mm) {
  const Eigen::Index joints = clip.joints - 1;
  return points_mm.middleCols(3, 3 * joints) - points_mm.leftCols(3).replicate(1, joints);
}

}  // namespace mcdbn
