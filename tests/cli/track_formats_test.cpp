// Tracks through the program: written by `project` in every format, read back by content.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/capture_bound.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "run_cli.hpp"

using namespace mcdbn::test;
using mcdbn::MatrixD;
using mcdbn::Track2d;

namespace {

/// To 1e-6, and missing where the other is.
bool same(const MatrixD& a, const MatrixD& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         ((a - b).array().abs() < 1e-6 || (a.array().isNaN() && b.array().isNaN())).all();
}

}  // namespace

TEST_CASE("project: a detector's track in every format that has room for it, read back to 1e-6") {
  const ScratchFolder folder;
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1.5 -o '{}'",
                              (folder / "motion").string()))
              .exit_code == 0);
  const auto clip = std::filesystem::directory_iterator(folder / "motion")->path();
  std::set<std::string> written;
  for (const auto& [like, set] : {std::pair{"openpose", "BODY_25"}, std::pair{"coco", "COCO_17"},
                                  std::pair{"mediapipe", "MEDIAPIPE_33"}}) {
    const auto project = [&, like = like](const std::string& format) {
      const auto path = folder / (format + "_" + like);
      const CliResult result = run_cli(fmt::format("project '{}' --like {} --format {} -o '{}'",
                                                   clip.string(), like, format, path.string()));
      CAPTURE(result.standard_error);
      REQUIRE(result.exit_code == 0);
      return path;
    };
    const Track2d wanted = mcdbn::read_track(project("csv"));
    for (const mcdbn::TrackFormat& format : mcdbn::track_formats()) {
      const auto& sets = format.joint_sets;
      if (!sets.empty() && std::ranges::find(sets, set) == sets.end()) continue;
      CAPTURE_BOUND(like);
      CAPTURE(format.name);
      written.insert(format.name);
      const auto path =
          format.name == "csv" ? folder / ("csv_" + std::string(like)) : project(format.name);
      const mcdbn::TrackReading reading = mcdbn::read_tracks(
          path,
          {.fps = wanted.fps, .image_size = mcdbn::ImageSize{wanted.width_px, wanted.height_px}});
      CHECK(reading.format == format.name);
      CHECK(reading.joint_set == set);
      const Track2d& read = reading.people.front();
      CHECK(read.keypoints.size() == wanted.keypoints.size());
      CHECK(same(read.x_px, wanted.x_px));
      CHECK(same(read.y_px, wanted.y_px));
      CHECK(same(read.confidence, wanted.confidence));
    }
  }
  CHECK(written.size() == mcdbn::track_formats().size());
}

TEST_CASE("project: a skeleton's own joints are read back as in our CSV from every format") {
  const ScratchFolder folder;
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1 -o '{}'",
                              (folder / "motion").string()))
              .exit_code == 0);
  const auto clip = std::filesystem::directory_iterator(folder / "motion")->path();
  const auto projected = [&](const std::string& format) {
    const auto path = folder / ("track_" + format);
    REQUIRE(run_cli(fmt::format("project '{}' --format {} -o '{}'", clip.string(), format,
                                path.string()))
                .exit_code == 0);
    return mcdbn::read_track(path);
  };
  const Track2d wanted = projected("csv");
  CHECK(wanted.keypoints.empty());
  for (const char* format : {"sleap", "deeplabcut"}) {
    CAPTURE(format);
    const Track2d read = projected(format);
    CHECK(read.joint_names == wanted.joint_names);
    CHECK(read.keypoints.empty());
    CHECK(same(read.x_px, wanted.x_px));
  }
}

TEST_CASE("project: a folder of frames that is not there may be named with a slash at its end") {
  const ScratchFolder folder;
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1 -o '{}'",
                              (folder / "motion").string()))
              .exit_code == 0);
  const auto clip = std::filesystem::directory_iterator(folder / "motion")->path();
  const auto project = [&](const std::string& format, const std::string& name) {
    return run_cli(fmt::format("project '{}' --like openpose --format {} -o '{}'", clip.string(),
                               format, (folder / name).string()));
  };
  const CliResult frames = project("openpose", "frames/");
  CAPTURE(frames.standard_error);
  REQUIRE(frames.exit_code == 0);
  CHECK(mcdbn::read_tracks(folder / "frames").joint_set == "BODY_25");
  const CliResult table = project("csv", "track.csv/");
  CHECK(table.exit_code == 3);
  CHECK(table.standard_error.find(
            "track.csv/: names a folder, by the slash at its end; name a file") !=
        std::string::npos);
  CHECK(entries_of(folder / "") == std::set<std::string>{"motion", "frames"});
}

TEST_CASE("project --like: a track too short to measure its noise is named") {
  const ScratchFolder folder;
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1 -o '{}'",
                              (folder / "motion").string()))
              .exit_code == 0);
  const auto clip = std::filesystem::directory_iterator(folder / "motion")->path();
  const auto project = [&](const std::string& like) {
    return run_cli(fmt::format("project '{}' --like '{}' -o '{}'", clip.string(), like,
                               (folder / "seen.csv").string()));
  };
  REQUIRE(project("openpose").exit_code == 0);
  // The comment, the header and four frames.
  std::string text = mcdbn::read_text_file(folder / "seen.csv");
  std::size_t end = 0;
  for (int line = 0; line < 6; ++line) end = text.find('\n', end) + 1;
  const auto few = folder.write("few.csv", text.substr(0, end)).string();
  const CliResult result = project(few);
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find(few + ": a track of 4 frames is too short") !=
        std::string::npos);
}
