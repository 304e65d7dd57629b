// Files of every format, with bytes changed, cut and doubled: they are read, or refused with
// InputError and no text of a library; nothing else may come out.
#include <doctest/doctest.h>

#include <filesystem>
#include <random>
#include <string>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "formats/figure_track.hpp"
#include "formats/layout_samples.hpp"
#include "fuzz/mutated.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace track_mutation_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr int kMutations = 300;

/// Reads it; the message of what refused it, or nothing.
std::string refusal(const std::filesystem::path& path, const std::string& format) {
  try {
    const TrackReading reading = read_tracks(path, {.format = format, .person = "all"});
    for (const Track2d& track : reading.people) {
      CHECK(track.frames() > 0);
      CHECK(track.fps > 0);
      CHECK(track.width_px > 0);
      CHECK((track.x_px.array().isNaN() == (track.confidence.array() == 0)).all());
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void check_mutations(const std::filesystem::path& file, const std::filesystem::path& read,
                     const std::string& format) {
  const std::string text = read_text_file(file);
  std::mt19937 random(29);
  int refused = 0;
  for (int i = 0; i < kMutations; ++i) {
    CAPTURE(i);
    write_text_file(file, mutated(text, random));
    // By content, and as what it was.
    for (const std::string& asked : {std::string(), format}) {
      const std::string message = refusal(read, asked);
      CHECK_MESSAGE(message.find("exception") == std::string::npos, message);
      if (!message.empty()) {
        ++refused;
        CHECK_MESSAGE(message.find(read.filename().string()) != std::string::npos, message);
      }
    }
  }
  CHECK(refused > 0);
  write_text_file(file, text);
}

}  // namespace

TEST_CASE("damaged tracks: what every format writes") {
  const ScratchFolder folder;
  for (const TrackFormat& format : track_formats()) {
    if (format.write == nullptr) continue;
    CAPTURE(format.name);
    const auto path = folder / ("damaged_" + format.name);
    format.write(path, figure_track(format, 3));
    const auto file = std::filesystem::is_directory(path)
                          ? std::filesystem::directory_iterator(path)->path()
                          : path;
    check_mutations(file, path, format.name);
  }
}

TEST_CASE("damaged tracks: layouts that others write") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    CAPTURE(sample.name);
    const auto path = folder.write("damaged_" + sample.name, sample.text);
    check_mutations(path, path, sample.format);
  }
}

}  // namespace track_mutation_test
