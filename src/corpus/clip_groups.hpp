#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mcdbn/corpus/clip_store.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// People of a corpus, as ClipGroups numbers them: all, all but one, or one alone.
struct PeopleChoice {
  std::optional<std::size_t> without = {}, only = {};

  bool holds(std::size_t person) const { return person != without && (!only || person == only); }
};

/// Numbers the people in clips, and person and action where actions are given.
class ClipGroups {
 public:
  explicit ClipGroups(const ClipStore& clips);

  /// Person of each clip, counted from 0.
  const std::vector<std::size_t>& people() const { return people_; }
  /// A number for each person and action, or people() where no action is given.
  const std::vector<std::size_t>& groups() const { return actions_given_ ? groups_ : people_; }
  /// TrainingSet::people and ::groups of a clip's sequences.
  void add(std::size_t clip, std::size_t sequences, TrainingSet& set) const;

 private:
  std::vector<std::size_t> people_, groups_;
  bool actions_given_;
};

}  // namespace mcdbn
