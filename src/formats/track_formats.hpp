#pragma once

#include "mcdbn/formats/track_file.hpp"

namespace mcdbn {

// One for each format, defined in its own source file and listed in track_file.cpp.
TrackFormat track_csv_format();

}  // namespace mcdbn
