#include "mcdbn/formats/track_file.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <set>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

Track2d small_track() {
  Track2d track;
  track.joint_names = {"Hips", "Head"};
  track.x_px = MatrixD::Constant(3, 2, 12.5);
  track.y_px = MatrixD::Constant(3, 2, 7.25);
  track.confidence = MatrixD::Ones(3, 2);
  return track;
}

}  // namespace

TEST_CASE("every track format has a name of its own, and recognises and reads what it writes") {
  const ScratchFolder folder;
  std::set<std::string> names;
  for (const TrackFormat& format : track_formats()) {
    CAPTURE(format.name);
    CHECK(names.insert(format.name).second);
    CHECK(std::string(format.about) != "");
    if (format.write == nullptr) continue;
    // The content tells, not the name.
    const auto path = folder / ("track_of_" + std::string(format.name));
    format.write(path, small_track());
    const TrackFormat* recognised = track_format_of(path);
    REQUIRE(recognised != nullptr);
    CHECK(std::string(recognised->name) == format.name);
    for (const std::string& asked : {std::string(), std::string(format.name)}) {
      const Track2d read = read_track(path, asked);
      CHECK(read.joint_names == small_track().joint_names);
      CHECK(read.x_px == small_track().x_px);
      CHECK(read.y_px == small_track().y_px);
      CHECK(read.confidence == small_track().confidence);
    }
  }
}

TEST_CASE("what no track format recognises is refused with a list of them") {
  const ScratchFolder folder;
  const auto path = folder / "notes.csv";
  std::ofstream(path) << "# nothing\nname,age\nx,1\n";
  CHECK(track_format_of(path) == nullptr);
  const std::string listed = track_formats().front().name;
  CHECK_THROWS_WITH_AS(read_track(path), doctest::Contains(listed.c_str()), InputError);
  CHECK_THROWS_WITH_AS(read_track(path, "no such"), doctest::Contains(listed.c_str()), InputError);
  CHECK_THROWS_AS(read_track(folder / "absent.csv"), InputError);
}
