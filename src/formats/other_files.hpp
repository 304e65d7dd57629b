#pragma once

#include <string>

#include "formats/track_source.hpp"

namespace mcdbn {

/// What a file, or a folder of files, is that holds no 2D track in a format that is read, and what
/// to do about it, for what people have beside their tracks: HDF5, archives, films, markers in
/// space. Empty: not known.
std::string what_else_it_is(const TrackSource& source);

}  // namespace mcdbn
