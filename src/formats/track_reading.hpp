#pragma once

#include "formats/seen_people.hpp"

namespace mcdbn {

/// What was seen as tracks of people: frames by number, coordinates in pixels, confidences up to 1,
/// people followed and chosen. `format` is left to the caller.
/// @param file for messages  @throws InputError as read_tracks
TrackReading tracks_of(SeenPeople seen, const TrackReadOptions& options, const std::string& file);

}  // namespace mcdbn
