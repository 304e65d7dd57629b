#pragma once

#include "formats/seen_people.hpp"
#include "formats/track_source.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace mcdbn {

// One for each format, defined in its own source file and listed in track_file.cpp.
TrackFormat track_csv_format();
TrackFormat track_openpose_format();
TrackFormat track_coco_format();

}  // namespace mcdbn
