#pragma once

#include <string>
#include <vector>

#include "corpus/encoded_clip.hpp"
#include "evaluation/clip_score.hpp"

namespace mcdbn {

/// One answer to a clip.
struct ScoredAnswer {
  Motion motion;
  ClipScore score;
  /// Deviations of the motion's joints along the world's axes, from the root (joint_uncertainty),
  /// in mm on a 1.7 m body [frames x 3·joints]; 0 x 0 where nothing was drawn.
  MatrixD deviation_mm = {};
};

/// Positions of the joints that are judged: all but the root and those that stand where their
/// parents stand in the truth. Joints are matched by name; an answer without the person's body
/// stands on the model's skeleton, and those that it lacks are not judged.
struct JudgedPlaces {
  std::vector<std::string> joints;
  /// [frames x 3·joints] along the world's axes, from the root, mm on a 1.7 m body.
  MatrixD truth_mm, answer_mm;
  MatrixD deviation_mm;  ///< of the answer, as many; 0 x 0 where it has none
};

/// @param answer as many frames as the truth, its skeleton with a joint `root_name`
/// @param deviation_mm as ScoredAnswer::deviation_mm
JudgedPlaces judged_places(const EncodedClip& truth, const Motion& answer,
                           const MatrixD& deviation_mm, const std::string& root_name);

/// @param answer as for judged_places
ClipScore score_clip(const EncodedClip& truth, const Motion& answer, const std::string& root_name);

/// Share of the 90 % intervals of an answer's judged joints that hold the truth
/// (ClipScore::within_90). @param answer with deviations, wherever they come from
double share_within_90(const EncodedClip& truth, const ScoredAnswer& answer,
                       const std::string& root_name);

}  // namespace mcdbn
