#include "mcdbn/formats/track_file.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <set>

#include "base/scratch_folder.hpp"
#include "formats/figure_track.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// To 1e-6, and missing where the other is.
bool same(const MatrixD& a, const MatrixD& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         ((a - b).array().abs() < 1e-6 || (a.array().isNaN() && b.array().isNaN())).all();
}

}  // namespace

TEST_CASE("every track format has a name of its own, and recognises and reads what it writes") {
  const ScratchFolder folder;
  std::set<std::string> names;
  for (const TrackFormat& format : track_formats()) {
    CAPTURE(format.name);
    CHECK(names.insert(format.name).second);
    CHECK(format.about != "");
    if (format.write == nullptr) continue;
    // The content decides, not the name.
    const auto path = folder / ("track_of_" + format.name);
    const Track2d written = figure_track(format);
    format.write(path, written);
    const TrackFormat* recognised = track_format_of(path);
    REQUIRE(recognised != nullptr);
    CHECK(recognised->name == format.name);
    for (const std::string& asked : {std::string(), format.name}) {
      const Track2d read = read_track(path, {.format = asked});
      CHECK(read.joint_names == written.joint_names);
      CHECK(same(read.x_px, written.x_px));
      CHECK(same(read.y_px, written.y_px));
      CHECK(same(read.confidence, written.confidence));
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
  CHECK_THROWS_WITH_AS(read_track(path, {.format = "no such"}), doctest::Contains(listed.c_str()),
                       InputError);
  CHECK_THROWS_AS(read_track(folder / "absent.csv"), InputError);
}
