#pragma once

#include "formats/csv_table.hpp"
#include "formats/json_text.hpp"
#include "formats/seen_people.hpp"

namespace mcdbn {

/// The rate and the image's size that a JSON file gives: beside its frames, in an object of such
/// facts there (`metadata`, `video_info`), or, the same in all, in each of them.
/// @throws InputError if one that stands beside the frames is out of range
void take_rate_and_size(const JsonPlace& content, SeenPeople& people);

/// Those that a table gives in columns, the same in all rows.
void take_rate_and_size(const CsvTable& table, SeenPeople& people);

}  // namespace mcdbn
