#pragma once

#include "formats/json_text.hpp"
#include "formats/seen_people.hpp"

namespace mcdbn {

/// Whether a header is of landmarks in columns (frame, NOSE_x, NOSE_y …) or in rows (frame,
/// landmark, x, y).
bool are_landmark_columns(std::string_view text);
bool are_landmark_rows(std::string_view text);

/// @throws InputError `file:line: what`
SeenPeople read_landmark_columns(std::string_view text, const std::string& file);
SeenPeople read_landmark_rows(std::string_view text, const std::string& file);

/// Whether the JSON holds frames of landmarks: objects with x and y, or lists of numbers.
bool are_landmarks(const JsonPlace& content);
/// @throws InputError `file: key's path: what`
SeenPeople read_landmarks(const JsonPlace& content, const std::string& file);

/// Names of joints that are only numbers ("L0", "landmark_12") say no more than their count.
bool are_only_numbered(const std::vector<std::string>& names);

}  // namespace mcdbn
