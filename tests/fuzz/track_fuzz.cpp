#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzz/fuzzed_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace {

void read_as(const std::filesystem::path& file, const std::string& format) {
  try {
    for (const mcdbn::Track2d& track :
         mcdbn::read_tracks(file, {.format = format, .person = "all"}).people)
      if (track.frames() == 0 || !(track.fps > 0)) std::abort();
  } catch (const mcdbn::InputError&) {
  }
}

}  // namespace

/// Any bytes are read as every format, or as the one that TRACK_FORMAT names, and as what they seem
/// to be, or refused with InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const char* const only = std::getenv("TRACK_FORMAT");
  const std::filesystem::path& file = mcdbn::test::fuzzed_file(data, size);
  read_as(file, {});
  for (const mcdbn::TrackFormat& format : mcdbn::track_formats())
    if (only == nullptr || format.name == only) read_as(file, format.name);
  return 0;
}
