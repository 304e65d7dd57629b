#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/report_clip.hpp"

namespace mcdbn {

/// Clips for the page's viewer, in at most `budget_bytes` of encoded motion. Clips that do not fit
/// are left out; it may be all.
struct PageMotion {
  nlohmann::ordered_json clips = nlohmann::ordered_json::array();
  std::size_t left_out_clips = 0;
  std::size_t samples = 0;  ///< shown of each clip
  bool others = true;       ///< the simpler methods' answers are shown, too
  int frame_step = 1;       ///< every so manieth frame is kept
};

PageMotion page_motion(const std::vector<ReportClip>& clips, std::size_t budget_bytes);

}  // namespace mcdbn
