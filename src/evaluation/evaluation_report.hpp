// The room evaluation: how good motion is: measures, distribution fits, the report.
// It uses camera.
// Add here: a measure: a pair of files, a member of ClipScore, a column in report_tables.cpp.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "camera/track_noise.hpp"
#include "evaluation/action_report.hpp"
#include "evaluation/coverage.hpp"

namespace mcdbn {

/// A sentence for people, and whether it is good news.
struct Verdict {
  enum class Kind { good, bad, note };
  Kind kind = Kind::note;
  std::string text;
};

/// A whole evaluation: what summary.json, the tables and report.html are made from.
struct EvaluationReport {
  std::string model;     ///< file name
  std::string protocol;  ///< subject, paper
  double temperature = 0;
  std::string fit = "none";      ///< track: every method's answer was fitted to the 2D track
  std::string tracks = "exact";  ///< or the detector that they are like
  bool camera_known = true;      ///< to the methods
  TrackDamage damage;            ///< done to the tracks before any method saw them
  std::vector<ReportClip> clips;
  std::vector<ActionReport> actions;  ///< analyse_actions of the clips
  /// Coverage of the model's intervals, if asked for: of joints in mm, of the network's channels.
  Coverage joints, channels;
};

/// Mean scores over every clip, whatever its action: `model` (all samples) first, then the others
/// by name. A report without clips has none.
std::vector<MethodReport> overall_methods(const EvaluationReport& report);

/// 2D from 3D: mean over the clips.
TrackError overall_track_error(const EvaluationReport& report);

/// What the figures show, in words: whether a baseline beats the model, whether the flattened
/// correlation carries information, how alike the regenerations are, whether training clips make
/// the figures better.
std::vector<Verdict> verdicts(const EvaluationReport& report);

/// {"clips", "frames", "model": {pcc_flat, …}, "baselines": {name: {…}},
/// "track_from_pose": {track_error_px, …}, "coverage": {"joints": …, "channels": …} if it was asked
/// for, …}; figures that are not
/// finite are null. Without the clips' motion.
nlohmann::ordered_json summary_json(const EvaluationReport& report);

}  // namespace mcdbn
