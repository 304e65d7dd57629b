#pragma once

#include <string>

#include "clips.hpp"
#include "evaluation/report_clip.hpp"

namespace mcdbn::test {

inline ClipScore score_of(double mpjpe_mm, double pcc_flat, double pcc_channel) {
  ClipScore score;
  score.error.mpjpe_mm = mpjpe_mm;
  score.pcc_flat = pcc_flat;
  score.pcc_channel = pcc_channel;
  return score;
}

/// A clip of 3 joints and one end, with samples near its own random truth.
inline ReportClip report_clip(const std::string& name, const std::string& action, unsigned seed,
                              int frames = 20, int samples = 3) {
  ReportClip clip;
  clip.name = name;
  clip.action = action;
  clip.point_names = {"Hips", "LeftArm", "Head", "Head end"};
  clip.parents = {-1, 0, 0, 2};
  clip.joints = 3;
  // About one pose, so that clips correlate.
  clip.truth_mm = random_clip(frames, 12, 300, seed);
  clip.truth_mm.rowwise() += RowVectorD::LinSpaced(12, -900, 900).array().cube().matrix() / 9e5;
  clip.track_px = random_clip(frames, 6, 100, seed + 1);
  clip.width_px = 1920;
  clip.height_px = 1080;
  for (int i = 0; i < samples; ++i) {
    const auto offset = static_cast<unsigned>(i) + 2;
    clip.samples.push_back({clip.truth_mm + random_clip(frames, 12, 60, seed + offset),
                            score_of(20.0 + i, 0.99 - 0.01 * i, 0.8 - 0.05 * i)});
  }
  clip.others["ridge_window"] = {clip.truth_mm, score_of(30, 0.97, 0.6)};
  clip.others["mean_pose"] = {clip.truth_mm, score_of(90, 0.95, 0)};
  return clip;
}

}  // namespace mcdbn::test
