// What regenerate reports of the film that a track is of: where the track begins in it, and a
// camera that moved. By the general model: the answer has to be that of a walker.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/text_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace film_warnings_test {

namespace {

/// A walker, from the left, as a detector's track in that format.
fs::path walker(const ScratchFolder& folder, const std::string& format, const std::string& like) {
  const fs::path motion = folder / "motion", track = folder / "track";
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1.5 -o '{}'",
                              motion.string()))
              .exit_code == 0);
  REQUIRE(run_cli(fmt::format("project '{}' --like {} --format {} --camera-azimuth 90 -o '{}'",
                              fs::directory_iterator(motion)->path().string(), like, format,
                              track.string()))
              .exit_code == 0);
  return track;
}

/// What it reports, but for what it does not need to be asked.
std::string reported(const ScratchFolder& folder, const fs::path& track,
                     const std::string& options = "") {
  const CliResult result =
      run_cli(fmt::format("regenerate --input '{}' -o '{}' --quiet {}", track.string(),
                          (folder / "out.bvh").string(), options));
  CHECK(result.exit_code == 0);
  return result.standard_error;
}

}  // namespace

TEST_CASE("regenerate: where a list of results begins in the film is reported, for render") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const auto results = nlohmann::json::parse(mcdbn::read_text_file(walker(folder, "coco", "coco")));
  const auto numbered = [&](const std::function<int(int)>& number) {
    auto entries = results;
    for (auto& entry : entries) entry["image_id"] = number(entry["image_id"].get<int>());
    return reported(folder, folder.write("results.json", entries.dump()), "--fit none");
  };
  const std::string later = numbered([](int frame) { return frame + 45; });
  CAPTURE(later);
  CHECK(
      later.find("results.json: its first frame is number 45, and the motion begins there: to draw "
                 "it over the whole film, render --over-from 45 (or 44, if the film's first frame "
                 "is number 1)\n") != std::string::npos);
  for (const int first : {0, 1})
    CHECK(numbered([&](int frame) { return frame + first; }).find("first frame") ==
          std::string::npos);
  // Numbers in steps are those of pictures taken out of a film.
  CHECK(numbered([](int frame) { return 5 * frame + 45; }).find("first frame") ==
        std::string::npos);
}

TEST_CASE("regenerate: of an array that has y before x it is said why the body lies in it") {
  if (!have_device()) return;
  const ScratchFolder folder;
  mcdbn::Track2d track = mcdbn::read_track(walker(folder, "npy", "coco"),
                                           {.fps = 30, .image_size = mcdbn::ImageSize{1920, 1080}});
  std::swap(track.x_px, track.y_px);
  std::swap(track.width_px, track.height_px);
  mcdbn::track_format("npy").write(folder / "movenet.npy", track);
  write_track_csv(folder / "named.csv", track);
  const std::string array =
      reported(folder, folder / "movenet.npy", "--fit none --fps 30 --image-size 1080 1920");
  CAPTURE(array);
  CHECK(array.find("in most frames the body lies across the image: exchange x and y in the file if "
                   "it has y first, as MoveNet's arrays do; set --camera-roll 90 if ") !=
        std::string::npos);
  // Columns say which of them is x.
  CHECK(reported(folder, folder / "named.csv", "--fit none")
            .find("lies across the image: set --camera-roll 90 if ") != std::string::npos);
}

TEST_CASE(
    "regenerate: a camera that is turned after a walker is reported, by the feet that slide") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const fs::path csv = walker(folder, "csv", "openpose");
  const std::string sliding = ": in most frames the feet slide, ";
  CHECK(reported(folder, csv).find(sliding) == std::string::npos);
  mcdbn::Track2d track = mcdbn::read_track_csv(csv);
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const auto seen = track.confidence.row(t).array() > 0;
    REQUIRE(seen.any());
    const double middle_px =
        seen.select(track.x_px.row(t).array(), 0.0).sum() / static_cast<double>(seen.count());
    track.x_px.row(t).array() += 0.5 * track.width_px - middle_px;
  }
  const auto turned = [&] {
    write_track_csv(folder / "turned.csv", track);
    return reported(folder, folder / "turned.csv");
  };
  CHECK(turned().find("turned.csv" + sliding) != std::string::npos);
  // Where no foot is seen they are made up.
  for (int joint = 0; joint < track.joint_count(); ++joint)
    for (const char* part : {"Ankle", "Heel", "Toe"})
      if (track.joint_names[static_cast<std::size_t>(joint)].find(part) != std::string::npos)
        track.confidence.col(joint).setZero();
  CHECK(turned().find(sliding) == std::string::npos);
}

}  // namespace film_warnings_test
