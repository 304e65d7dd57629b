#pragma once

#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Names the joints where several joint sets have their count (SeenPeople::possible_sets): the
/// usual set, unless another is clearly more like a person. What is compared is, for each set, how
/// alike the distances between the joints that are seen are to those in a person who stands, arms
/// hanging or raised: the cosine of the angle between the two lists of distances. It depends
/// neither on the person's size nor on where and how they are turned in the image, and both sets
/// are judged by the same joints. A person of whom little is seen decides nothing.
/// @param frames people of each frame, in pixels
void name_likeliest_set(SeenPeople& people, const std::vector<std::vector<SeenPerson>>& frames);

}  // namespace mcdbn
