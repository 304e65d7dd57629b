#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "corpus/people.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// Numbers who is seen in clips, and who does what where somebody said actions.
class ClipGroups {
 public:
  explicit ClipGroups(const std::vector<LoadedClip>& clips);
  /// TrainingSet::people and ::groups of a clip's sequences.
  void add(const LoadedClip& clip, std::size_t sequences, TrainingSet& set);

 private:
  PeopleCount people_;
  std::map<std::pair<std::size_t, std::string>, std::size_t> groups_;
  bool actions_said_;
};

}  // namespace mcdbn
