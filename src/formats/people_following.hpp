#pragma once

#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Which of a frame's people it is.
struct Sighting {
  int frame, person;
};

/// One person over the frames, in their order: those in which they are seen.
using Followed = std::vector<Sighting>;

/// Matches the people of each frame to those of the frames before: those of a frame are assigned to
/// those followed so far by the smallest sum of costs (cheapest_assignment); the cost of a pair is
/// the mean distance of the joints that both show, as a share of the body's box, and half of what
/// their boxes and their joints do not share. A body that detectors find in parts, or not whole,
/// stays the one it was. An unseen person is expected where the path so far leads, for `patience`
/// frames, over which the reach grows. Where the file numbers its people, each number once a frame,
/// its numbers count, and only who has a new number is assigned, to those whose number is seen no
/// more, if no other pair fits as well: trackers give a person whom they lose a new number.
/// @param patience frames for which a person may be unseen
/// @return the people, the largest first: by the sum of their boxes over all frames
/// @throws Interrupted
std::vector<Followed> follow_people(const std::vector<std::vector<SeenPerson>>& frames,
                                    int patience);

/// A person who has another number of the file's from a frame on.
struct NumberChange {
  long long before, after;
  int frame;
};

/// Where the numbers of people change, person by person; none where the numbers do not count.
/// @param people as follow_people found them
std::vector<NumberChange> number_changes(const std::vector<std::vector<SeenPerson>>& frames,
                                         const std::vector<Followed>& people);

}  // namespace mcdbn
