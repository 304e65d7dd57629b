#pragma once

#include "formats/json_text.hpp"
#include "formats/seen_people.hpp"

namespace mcdbn {

/// Whether a header is of landmarks in columns (frame, NOSE_x, NOSE_y …) or in rows (frame,
/// landmark, x, y).
bool are_landmark_columns(std::string_view text);
bool are_landmark_rows(std::string_view text);

/// Whether a table's column of this name has the person's number: person, track_id, pose_id.
bool is_person_column(std::string_view name);

/// @throws InputError `file:line: what`
SeenPeople read_landmark_columns(std::string_view text, const std::string& file);
SeenPeople read_landmark_rows(std::string_view text, const std::string& file);

/// Whether the JSON holds frames of landmarks: objects with x and y, or lists of numbers.
bool are_landmarks(const JsonPlace& content);
/// @throws InputError `file: key's path: what`
SeenPeople read_landmarks(const JsonPlace& content, const std::string& file);

/// Names the landmarks: by their count where the names are only numbers ("L0",
/// "landmark_12") or there are none; as a joint set, in its order, where the names are its joints'
/// in any order and spelling (an object's keys have no order); else as they are called.
/// @throws InputError if the people's counts differ
void name_landmarks(SeenPeople& people, const std::string& file,
                    const std::vector<std::string>& names);

}  // namespace mcdbn
