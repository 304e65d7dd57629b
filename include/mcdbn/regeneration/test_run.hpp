#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/evaluation/joint_error.hpp"
#include "mcdbn/model/encoded_clip.hpp"
#include "mcdbn/model/model_file.hpp"
#include "mcdbn/regeneration/clip_regeneration.hpp"

namespace mcdbn {

/// How close one regenerated clip is to the truth: over forward kinematics on the test clip's own
/// skeleton, root-relative, joints that do not coincide with their parent, on a 1.7 m body.
struct ClipScore {
  double pcc_flat = 0;     ///< the paper's figure
  double pcc_channel = 0;  ///< mean over channels: the strict one
  JointError error;
  double root_mm = 0;  ///< mean distance of the regenerated root from the true one, in the world
};

/// What a test run is made of, and what it costs to know the answer's skeleton and camera: both are
/// the test clip's; its motion is not shown to anyone.
struct TestRunOptions {
  CameraPlacement camera;
  RegenerationOptions regeneration;
  bool keep_first_frame = false;
  bool include_training = false;  ///< else a clip that was trained on is refused
  bool baselines = true;
};

struct ClipResult {
  EncodedClip truth;
  bool trained_on = false;
  std::vector<Motion> regenerated;  ///< one a sample
  std::vector<ClipScore> scores;    ///< of each sample
  std::map<std::string, ClipScore> baseline_scores;
};

/// @throws InputError if a clip was trained on, or a training clip that the baselines need is gone
std::vector<ClipResult> run_test(const Model& model,
                                 const std::vector<std::filesystem::path>& files,
                                 const TestRunOptions& options);

ClipScore score_clip(const EncodedClip& truth, const Motion& regenerated,
                     const std::string& root_name);
/// Mean over clips (and samples).
ClipScore mean_score(const std::vector<ClipScore>& scores);

}  // namespace mcdbn
