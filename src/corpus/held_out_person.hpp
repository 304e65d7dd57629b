#pragma once

#include <optional>
#include <vector>

#include "mcdbn/corpus/clip_store.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// The person with the least data: of those with several clips (of all, if there are none) the one
/// with the fewest frames. None if there are fewer than `fewest_people`, or if that is 0.
/// @param views with `people` and `clips` for each of `poses`
std::optional<std::size_t> person_to_hold_out(const TrainingSet& views, std::size_t fewest_people);

/// As person_to_hold_out() of views, for clips: the person with the least data.
std::optional<std::size_t> person_to_hold_out(const ClipStore& clips, std::size_t fewest_people);

/// The views of that person alone, or of all others.
TrainingSet views_of(const TrainingSet& views, std::size_t person);
TrainingSet views_without(const TrainingSet& views, std::size_t person);

/// File names of a set's clips, each once.
std::vector<std::string> clip_names(const TrainingSet& views);

/// File names of all clips of a person, each once.
/// @param person as ClipGroups numbers them
std::vector<std::string> clip_names(const ClipStore& clips, std::size_t person);

}  // namespace mcdbn
