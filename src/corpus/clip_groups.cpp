#include "corpus/clip_groups.hpp"

#include <algorithm>

namespace mcdbn {

ClipGroups::ClipGroups(const std::vector<LoadedClip>& clips)
    : actions_said_(std::ranges::any_of(
          clips, [](const LoadedClip& loaded) { return !loaded.action.empty(); })) {}

void ClipGroups::add(const LoadedClip& clip, std::size_t sequences, TrainingSet& set) {
  const std::size_t person = people_.number_of(clip.motion.skeleton, clip.person);
  set.people.insert(set.people.end(), sequences, person);
  if (!actions_said_) return;
  const auto group = groups_.try_emplace({person, clip.action}, groups_.size()).first;
  set.groups.insert(set.groups.end(), sequences, group->second);
}

}  // namespace mcdbn
