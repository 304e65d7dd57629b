#pragma once

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Where neither file nor options give it.
inline constexpr double kUsualFps = 30.0;
/// Beyond it a coordinate is no pixel.
inline constexpr double kFarthest_px = 1e6;
/// For how long an unseen person is awaited.
inline constexpr double kPatience_s = 1.5;

/// What was seen as tracks of people: frames by number, coordinates in pixels, confidences up to 1,
/// people followed and chosen. `format` is left to the caller.
/// @param file for messages  @throws InputError as read_tracks
TrackReading tracks_of(SeenPeople seen, const TrackReadOptions& options, const std::string& file);

}  // namespace mcdbn
