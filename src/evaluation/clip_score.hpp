#pragma once

#include <limits>
#include <vector>

#include "evaluation/foot_slide.hpp"
#include "mcdbn/evaluation/joint_error.hpp"
#include "mcdbn/evaluation/limb_error.hpp"

namespace mcdbn {

/// How close one regenerated clip is to the truth: over forward kinematics on the test clip's own
/// skeleton, root-relative, joints that do not coincide with their parent, on a 1.7 m body.
struct ClipScore {
  double pcc_flat = 0;     ///< the paper's figure
  double pcc_channel = 0;  ///< mean over channels: the strict one
  JointError error;
  LimbError limbs;
  double mpjae_deg = 0;  ///< mean angle of joints' orientations in the world: orientation_error.hpp
  /// Mean distance of the regenerated root from the true one, in the world; NaN where the camera is
  /// not known, and with it not where in the world the answer stands.
  double root_mm = 0;
  FootSlide foot_slide;
  double bone_length_spread_mm = 0;
  /// Share of 90 % intervals that hold the truth (share_within_90), each joint but the root along
  /// each axis of the world, from the root; NaN where the answer has no uncertainty.
  double within_90 = std::numeric_limits<double>::quiet_NaN();
};

/// Mean over clips (and samples) of each figure; a figure that is NaN somewhere (the foot slide of
/// a clip without a planted foot) is averaged over the others. NaN throughout without a score.
ClipScore mean_score(const std::vector<ClipScore>& scores);

/// One figure of a score, as tables and JSON name it.
struct ScoreFigure {
  const char* name;   ///< with its unit: mpjpe_mm
  const char* title;  ///< as people read it: MPJPE (mm)
  double (*of)(const ClipScore&);
  bool smaller_is_better;  ///< of `within_90`, best at 0.9, neither is
};

/// Every figure of a score, in the order of reports.
const std::vector<ScoreFigure>& score_figures();

}  // namespace mcdbn
