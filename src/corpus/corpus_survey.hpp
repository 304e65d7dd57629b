#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/motion/retarget_error.hpp"

namespace mcdbn {

/// Something odd about a clip.
struct ClipProblem {
  enum class Kind { unreadable, no_person, first_frame, rate, length, spikes, jumps, ground, up };
  Kind kind;
  std::string text;
};
std::string_view name_of(ClipProblem::Kind kind);

/// What there is to know of a clip before it is trained on.
struct SurveyedClip {
  ListedClip clip;  ///< person and action as given, or by names, folders and bones
  int frames = 0;
  double fps = 0;
  std::size_t skeleton = 0;  ///< which of the corpus' skeletons, by joint names, from 1 on
  std::optional<RetargetError> error;  ///< of the canonical humanoid
  std::vector<ClipProblem> problems;

  bool usable() const { return error.has_value(); }
  double seconds() const { return frames > 0 ? frames / fps : 0; }
};

/// Reads every clip; what cannot be read is a problem of that clip.
/// @param joint_map roles of clips' joints, given by hand
/// @param notices if given, collects the joint map's names that no clip has
std::vector<SurveyedClip> survey(const std::vector<ListedClip>& clips,
                                 const JointMap& joint_map = {},
                                 std::vector<std::string>* notices = nullptr);

/// The problems of a motion that is read, of a person whose joints have roles.
std::vector<ClipProblem> motion_problems(const Motion& motion, const SkeletonRoles& roles);

}  // namespace mcdbn
