#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/clip_score.hpp"
#include "evaluation/track_error.hpp"

namespace mcdbn {

/// One regeneration of a clip, by the model or by a baseline.
struct ReportMotion {
  MatrixD points_mm;  ///< [frames x 3·points], as ReportClip::truth_mm
  ClipScore score;
  /// Deviation of each joint from the root, along the world's axes [frames x 3·joints], 0 for the
  /// root itself; 0 x 0 where the answer has none.
  MatrixD deviation_mm = {};
};

/// One test clip of a report. Points are joints first (the root, then those that are judged), then
/// the ends of limbs, which are only drawn.
struct ReportClip {
  std::string name;    ///< unique in the report
  std::string action;  ///< what it is counted under
  bool trained_on = false;
  /// Who it is, if another clip of the same person was trained on, else empty; nothing where that
  /// is not known.
  std::optional<std::string> known_person = "";
  double fps = 30.0;
  std::vector<std::string> point_names;
  std::vector<int> parents;  ///< of each point, −1 for the root
  int joints = 0;            ///< how many of the points are judged, the root included
  MatrixD truth_mm;          ///< [frames x 3·points] in the world, mm on a 1.7 m body, +y up
  MatrixD track_px;          ///< [frames x 2·joints] what the camera saw, NaN where it did not
  int width_px = 0, height_px = 0;
  std::vector<ReportMotion> samples;
  /// By name; `mean_field` is the model's single answer where the samples are drawn.
  std::map<std::string, ReportMotion> others;
  TrackError track;  ///< of the model's other direction, 2D from 3D

  int frames() const { return static_cast<int>(truth_mm.rows()); }
};

/// Where the clips of `others` that are the model's own single answer stand.
inline constexpr const char* kMeanField = "mean_field";

/// The judged joints relative to the root, without the root's own columns (which are zero and would
/// flatter a flattened correlation). @return [frames x 3·(joints − 1)]
MatrixD judged_positions(const ReportClip& clip, const MatrixD& points_mm);

}  // namespace mcdbn
