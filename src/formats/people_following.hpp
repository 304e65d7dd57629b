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

/// Matches the people of each frame to those of the frames before. Where the file numbers its
/// people, each number once a frame, its numbers count. Else those of a frame are assigned to those
/// followed so far by the smallest sum of costs (cheapest_assignment); the cost of a pair is the
/// mean distance of the joints that both show, as a share of the body's box, and half of what their
/// boxes and their joints do not share. A body that detectors find in parts, or not whole, stays
/// the one it was. An unseen person is expected where the path so far leads, for `patience` frames,
/// over which the reach grows.
/// @param patience frames for which a person may be unseen
/// @return the people, the largest first: by the sum of their boxes over all frames
/// @throws Interrupted
std::vector<Followed> follow_people(const std::vector<std::vector<SeenPerson>>& frames,
                                    int patience);

}  // namespace mcdbn
