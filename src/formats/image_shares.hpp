#pragma once

#include <string>
#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Coordinates up to here are shares of the image: no body in pixels is that small.
inline constexpr double kLargestShare = 3.0;

/// Whether coordinates are shares of the image's width and height, not pixels: those of more than
/// half of all joints are at most kLargestShare. Single joints may be guessed anywhere outside.
/// @param frames people of each frame  @param depths as below  @param file for messages
/// @throws InputError if they are neither, but those of a body in space about the origin
bool are_shares(const std::vector<std::vector<SeenPerson>>& frames, bool depths,
                const std::string& file);

/// Refuses points in space, as FreeMoCap's millimetres and the metres of MMPose's bodies: more of
/// them lie left of or above the image than a detector guesses there of people who are partly in
/// the picture.
/// @param depths whether joints have a third coordinate (SeenPeople::has_depths_only)
/// @throws InputError
void require_image_places(const std::vector<std::vector<SeenPerson>>& frames, bool depths,
                          const std::string& file);

/// Shares become pixels of an image of that size.
void shares_to_px(std::vector<SeenPerson>& people, const ImageSize& size);

}  // namespace mcdbn
