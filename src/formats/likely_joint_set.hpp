#pragma once

#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Names the joints where several joint sets have their count (SeenPeople::possible_sets): the
/// usual set, unless people are clearly more like somebody who stands (StandingLikeness) if their
/// joints are those of another. All sets are judged by the same joints. A person of whom little is
/// seen decides nothing.
/// @param frames people of each frame, in pixels
void name_likeliest_set(SeenPeople& people, const std::vector<std::vector<SeenPerson>>& frames);

}  // namespace mcdbn
