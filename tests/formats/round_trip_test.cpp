// Tracks of every joint set in every format, there and back, with frames that show nobody.
#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "formats/figure_track.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace round_trip_test {

namespace {

/// A figure that is seen in the frames with a 1.
Track2d figure_seen(const TrackFormat& format, const std::string& set, const std::string& seen) {
  TrackFormat of_set = format;
  if (!set.empty()) of_set.joint_sets = {set};
  Track2d track = figure_track(of_set, static_cast<int>(seen.size()));
  track.fps = 30;
  track.width_px = 1280;
  track.height_px = 720;
  for (int frame = 0; frame < track.frames(); ++frame) {
    if (seen[static_cast<std::size_t>(frame)] == '1') continue;
    track.x_px.row(frame).setConstant(std::numeric_limits<double>::quiet_NaN());
    track.y_px.row(frame).setConstant(std::numeric_limits<double>::quiet_NaN());
    track.confidence.row(frame).setZero();
  }
  return track;
}

/// To 1e-6, and missing where the other is.
bool is_same(const MatrixD& a, const MatrixD& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         ((a - b).array().abs() < 1e-6 || (a.array().isNaN() && b.array().isNaN())).all();
}

void check_round_trip(const TrackFormat& format, const std::string& set, const std::string& seen) {
  CAPTURE(format.name);
  CAPTURE(set);
  CAPTURE(seen);
  const ScratchFolder folder;
  const Track2d written = figure_seen(format, set, seen);
  format.write(folder / "track", written);
  const TrackReading reading = read_tracks(
      folder / "track", {.format = format.name, .fps = 30, .image_size = ImageSize{1280, 720}});
  CHECK(reading.joint_set == set);
  const Track2d& read = reading.people.front();
  CHECK(read.joint_names == written.joint_names);
  CHECK(is_same(read.x_px, written.x_px));
  CHECK(is_same(read.y_px, written.y_px));
  CHECK(is_same(read.confidence, written.confidence));
}

}  // namespace

TEST_CASE("round trips: every frame comes back, whoever is seen in it, in every joint set") {
  // At the beginning, in the middle, at the end; every other one; one of many.
  std::vector<std::string> patterns{"11", "101", "100", "001", "10101", "0001000", "1000001"};
  patterns.push_back(std::string(150, '0') + "1" + std::string(149, '0'));
  for (const TrackFormat& format : track_formats()) {
    const std::vector<std::string> own{""};
    for (const std::string& set : format.joint_sets.empty() ? own : format.joint_sets)
      for (const std::string& seen : patterns) check_round_trip(format, set, seen);
  }
}

TEST_CASE("round trips: lists of people keep frames of which none shows anybody") {
  for (const char* format : {"alphapose", "coco"})
    for (const std::string& seen : {std::string("00"), std::string("00000"), std::string(400, '0')})
      check_round_trip(track_format(format), "COCO_17", seen);
}

}  // namespace round_trip_test
