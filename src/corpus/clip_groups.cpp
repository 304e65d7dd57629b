#include "corpus/clip_groups.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "corpus/people.hpp"

namespace mcdbn {

ClipGroups::ClipGroups(const ClipStore& clips)
    : actions_given_(std::ranges::any_of(
          clips.records(), [](const ClipRecord& record) { return !record.clip.action.empty(); })) {
  PeopleCount count;
  std::map<std::pair<std::size_t, std::string>, std::size_t> numbers;
  for (const ClipRecord& record : clips.records()) {
    people_.push_back(count.number_of(record.skeleton, record.clip.person));
    groups_.push_back(
        numbers.try_emplace({people_.back(), record.clip.action}, numbers.size()).first->second);
  }
}

void ClipGroups::add(std::size_t clip, std::size_t sequences, TrainingSet& set) const {
  set.people.insert(set.people.end(), sequences, people_[clip]);
  if (actions_given_) set.groups.insert(set.groups.end(), sequences, groups_[clip]);
}

}  // namespace mcdbn
