#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace {

/// Overwritten for every input.
const std::filesystem::path& input_file() {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("track_fuzz_" + std::to_string(::getpid()));
  return path;
}

void read_as(const std::string& format) {
  try {
    for (const mcdbn::Track2d& track :
         mcdbn::read_tracks(input_file(), {.format = format, .person = "all"}).people)
      if (track.frames() == 0 || !(track.fps > 0)) std::abort();
  } catch (const mcdbn::InputError&) {
  }
}

}  // namespace

/// Any bytes are read as every format, and as what they seem to be, or refused with InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ofstream(input_file(), std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  read_as({});
  for (const mcdbn::TrackFormat& format : mcdbn::track_formats()) read_as(format.name);
  return 0;
}
