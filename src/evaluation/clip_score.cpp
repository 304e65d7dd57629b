#include "evaluation/clip_score.hpp"

#include <cmath>
#include <limits>

namespace mcdbn {
namespace {

template <typename Member>
double finite_mean(const std::vector<ClipScore>& scores, Member&& member) {
  double sum = 0;
  int count = 0;
  for (const ClipScore& score : scores) {
    if (!std::isfinite(member(score))) continue;
    sum += member(score);
    ++count;
  }
  return count ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

ClipScore mean_score(const std::vector<ClipScore>& scores) {
  using S = ClipScore;
  const auto mean = [&](auto&& member) { return finite_mean(scores, member); };
  S result;
  result.pcc_flat = mean([](const S& s) { return s.pcc_flat; });
  result.pcc_channel = mean([](const S& s) { return s.pcc_channel; });
  result.mpjae_deg = mean([](const S& s) { return s.mpjae_deg; });
  result.root_mm = mean([](const S& s) { return s.root_mm; });
  result.error.mpjpe_mm = mean([](const S& s) { return s.error.mpjpe_mm; });
  result.error.pa_mpjpe_mm = mean([](const S& s) { return s.error.pa_mpjpe_mm; });
  result.error.mpjve_mm_s = mean([](const S& s) { return s.error.mpjve_mm_s; });
  result.error.acceleration_error_mm_s2 =
      mean([](const S& s) { return s.error.acceleration_error_mm_s2; });
  result.error.pck_150mm = mean([](const S& s) { return s.error.pck_150mm; });
  result.error.rmse_mm = mean([](const S& s) { return s.error.rmse_mm; });
  result.limbs.mpjpe_mm = mean([](const S& s) { return s.limbs.mpjpe_mm; });
  result.limbs.turned_mpjpe_mm = mean([](const S& s) { return s.limbs.turned_mpjpe_mm; });
  result.limbs.pa_mpjpe_mm = mean([](const S& s) { return s.limbs.pa_mpjpe_mm; });
  result.bone_length_spread_mm = mean([](const S& s) { return s.bone_length_spread_mm; });
  result.foot_slide.truth_mm_s = mean([](const S& s) { return s.foot_slide.truth_mm_s; });
  result.foot_slide.regenerated_mm_s =
      mean([](const S& s) { return s.foot_slide.regenerated_mm_s; });
  result.within_90 = mean([](const S& s) { return s.within_90; });
  for (const S& score : scores) result.foot_slide.planted += score.foot_slide.planted;
  return result;
}

const std::vector<ScoreFigure>& score_figures() {
  using S = ClipScore;
  static const std::vector<ScoreFigure> figures = {
      {"pcc_flat", "PCC, flattened", [](const S& s) { return s.pcc_flat; }, false},
      {"pcc_channel", "PCC, per channel", [](const S& s) { return s.pcc_channel; }, false},
      {"mpjpe_mm", "MPJPE (mm)", [](const S& s) { return s.error.mpjpe_mm; }, true},
      {"pa_mpjpe_mm", "PA-MPJPE (mm)", [](const S& s) { return s.error.pa_mpjpe_mm; }, true},
      {"limb_mpjpe_mm", "MPJPE, limbs (mm)", [](const S& s) { return s.limbs.mpjpe_mm; }, true},
      {"limb_turned_mpjpe_mm", "MPJPE, limbs, one rotation (mm)",
       [](const S& s) { return s.limbs.turned_mpjpe_mm; }, true},
      {"limb_pa_mpjpe_mm", "PA-MPJPE, limbs (mm)", [](const S& s) { return s.limbs.pa_mpjpe_mm; },
       true},
      {"mpjae_deg", "MPJAE (°)", [](const S& s) { return s.mpjae_deg; }, true},
      {"mpjve_mm_s", "MPJVE (mm/s)", [](const S& s) { return s.error.mpjve_mm_s; }, true},
      {"acceleration_error_mm_s2", "Acceleration error (mm/s²)",
       [](const S& s) { return s.error.acceleration_error_mm_s2; }, true},
      {"pck_150mm", "PCK @ 150 mm", [](const S& s) { return s.error.pck_150mm; }, false},
      {"root_mm", "Root error (mm)", [](const S& s) { return s.root_mm; }, true},
      {"rmse_mm", "RMSE (mm)", [](const S& s) { return s.error.rmse_mm; }, true},
      {"foot_slide_mm_s", "Foot slide (mm/s)",
       [](const S& s) { return s.foot_slide.regenerated_mm_s; }, true},
      {"bone_length_spread_mm", "Bone-length spread (mm)",
       [](const S& s) { return s.bone_length_spread_mm; }, true},
      {"within_90", "Truths within 90 % intervals", [](const S& s) { return s.within_90; }, false},
  };
  return figures;
}

}  // namespace mcdbn
