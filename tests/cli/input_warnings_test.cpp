// What is odd about an input is reported by every command that reads it, also where --quiet hides
// the rest.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/text_file.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// A clip of the pipeline, at another rate: its frame time is so many seconds.
fs::path clip_at(const ScratchFolder& folder, const std::string& clip, const std::string& seconds) {
  std::string text = mcdbn::read_text_file(TinyPipeline::instance().motion() / clip);
  const std::string words = "Frame Time: ";
  const auto begin = text.find(words) + words.size();
  text.replace(begin, text.find('\n', begin) - begin, seconds);
  return folder.write(clip, text);
}

void check_warned(const std::string& arguments, const std::string& warning) {
  CAPTURE(arguments);
  const CliResult result = run_cli(arguments);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  const auto at = result.standard_error.find("mcdbn-cl: warning: " + warning);
  REQUIRE(at != std::string::npos);
  CHECK(result.standard_error.find(warning, at + 1 + warning.size()) == std::string::npos);
}

}  // namespace

TEST_CASE("a frame rate that no clip has is reported by every command that reads one, once") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder, out;
  const std::string clip = clip_at(folder, "walk_s01_01.bvh", "0.5").string(),
                    model = pipeline.model().string();
  const std::string warning = clip + ": it has 2 frames a second; correct it if that is not so\n";
  const auto to = [&](const char* name) { return (out / name).string(); };
  check_warned(fmt::format("info '{}'", clip), warning);
  check_warned(fmt::format("project '{}' -o '{}' --quiet", clip, to("t.csv")), warning);
  check_warned(fmt::format("render '{}' -o '{}' --quiet", clip, to("r.png")), warning);
  check_warned(fmt::format("generate --model '{}' --seed-clip '{}' -o '{}' --frames 3 --quiet",
                           model, clip, to("g.bvh")),
               warning);
  check_warned(fmt::format("regenerate --model '{}' --to track --input '{}' -o '{}' --quiet", model,
                           clip, to("t2.csv")),
               warning);
  check_warned(fmt::format("evaluate --model '{}' --test '{}' --fit none --baselines none --quiet",
                           model, clip),
               warning);
  check_warned(fmt::format("train '{}' {} -o '{}' {} --quiet", clip, pipeline.training_clips(),
                           to("run"), kTiny),
               warning);
  // Of several trainings on the same clips once, too.
  const fs::path sweep =
      folder.write("sweep.toml", fmt::format("test = ['{}']\n[grid]\nseed = [1, 2]\n",
                                             (pipeline.motion() / "walk_s02_01.bvh").string()));
  check_warned(fmt::format("train '{}' {} -o '{}' {} --sweep '{}' --quiet", clip,
                           pipeline.training_clips(), to("sweep"), kTiny, sweep.string()),
               warning);
}

TEST_CASE("of a camera that looks steeply down it is reported what the network does not see") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  // @return what regenerate reports of a track from that elevation
  const auto reported = [&](int elevation_deg, const std::string& options) {
    REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}' --camera-elevation {}",
                                (pipeline.motion() / "walk_s02_01.bvh").string(), file("t.csv"),
                                file("c.yaml"), elevation_deg))
                .exit_code == 0);
    const CliResult result = run_cli(fmt::format(
        "regenerate --model '{}' --input '{}' --camera '{}' -o '{}' --fit none {}",
        pipeline.model().string(), file("t.csv"), file("c.yaml"), file("o.bvh"), options));
    CHECK(result.exit_code == 0);
    return result.standard_error;
  };
  const std::string steep = reported(85, "--quiet");
  CAPTURE(steep);
  CHECK(steep.find("mcdbn-cl: warning: " + file("t.csv") + ": ") == 0);
  CHECK(steep.find(" seen joints are outside of the level view, 84 degrees and more from its "
                   "direction") != std::string::npos);
  CHECK(steep.find("never seen") == std::string::npos);
  CHECK(steep.find("missing joints") == std::string::npos);
  // Of a usual view there is nothing to warn of: of its own camera file all is known.
  CHECK(reported(10, "--quiet").empty());
  const std::string usual = reported(10, "");
  CAPTURE(usual);
  CHECK(usual.find("warning") == std::string::npos);
  for (const char* line : {": its world is y-up (opencv)\n", " m are scaled to the motion's, "})
    CHECK(usual.find(line) != std::string::npos);
}

TEST_CASE("of a film that may be stored turned it is reported which roll sets the body upright") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const auto file = [&](const std::string& name) { return (folder / name).string(); };
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}'",
                              (pipeline.motion() / "walk_s02_01.bvh").string(), file("upright.csv"),
                              file("c.yaml")))
              .exit_code == 0);
  const auto reported = [&](const std::string& track, const std::string& options) {
    const CliResult result =
        run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' --fit none --quiet {}",
                            pipeline.model().string(), file(track), file("o.bvh"), options));
    CHECK(result.exit_code == 0);
    return result.standard_error;
  };
  const mcdbn::Track2d upright = mcdbn::read_track_csv(file("upright.csv"));
  mcdbn::Track2d clockwise = upright, around = upright;
  std::swap(clockwise.width_px, clockwise.height_px);
  clockwise.x_px = upright.height_px - upright.y_px.array();
  clockwise.y_px = upright.x_px;
  around.x_px = upright.width_px - upright.x_px.array();
  around.y_px = upright.height_px - upright.y_px.array();
  write_track_csv(file("clockwise.csv"), clockwise);
  write_track_csv(file("around.csv"), around);
  CHECK(reported("upright.csv", "").find("in most frames") == std::string::npos);
  CHECK(reported("clockwise.csv", "")
            .find("warning: " + file("clockwise.csv") +
                  ": in most frames the body lies across the image: set --camera-roll -90 if the "
                  "film is stored turned, or --camera-roll 0 if the person lies there\n") !=
        std::string::npos);
  CHECK(reported("around.csv", "")
            .find("warning: " + file("around.csv") +
                  ": in most frames the body is upside down in the image: set --camera-roll 180 if "
                  "the film is stored turned, or --camera-roll 0 if the person stands on the "
                  "hands\n") != std::string::npos);
  // Who gives the roll, or the camera, knows it.
  CHECK(reported("clockwise.csv", "--camera-roll -90").find("in most frames") == std::string::npos);
  CHECK(reported("clockwise.csv", "--camera-roll 0").find("in most frames") == std::string::npos);
  CHECK(
      reported("around.csv", fmt::format("--camera '{}'", file("c.yaml"))).find("in most frames") ==
      std::string::npos);
}

TEST_CASE("it is reported from what an unknown camera's angles are found") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}'",
                              (pipeline.motion() / "walk_s02_01.bvh").string(), file("t.csv")))
              .exit_code == 0);
  const auto reported = [&](const std::string& options) {
    const CliResult result =
        run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' --quiet {}",
                            pipeline.model().string(), file("t.csv"), file("o.bvh"), options));
    CHECK(result.exit_code == 0);
    return result.standard_error;
  };
  const std::string angles = "assumed to look down by ", by_feet = " (from feet on level ground), ";
  CHECK(reported("").find(by_feet) != std::string::npos);
  mcdbn::Track2d track = mcdbn::read_track_csv(file("t.csv"));
  for (const char* side : {"Left", "Right"})
    for (const char* joint : {"Foot", "ToeBase"}) {
      const int column = track.find(std::string(side) + joint);
      REQUIRE(column >= 0);
      track.confidence.col(column).setZero();
      for (mcdbn::MatrixD* values : {&track.x_px, &track.y_px})
        values->col(column).setConstant(std::nan(""));
    }
  write_track_csv(file("t.csv"), track);
  const std::string without_feet = reported("");
  CAPTURE(without_feet);
  CHECK(without_feet.find(" (from the posture: no foot is seen), ") != std::string::npos);
  CHECK(without_feet.find("level ground") == std::string::npos);
  const std::string unfitted = reported("--fit none");
  CHECK(unfitted.find(angles) != std::string::npos);
  CHECK(unfitted.find("(from") == std::string::npos);
}

TEST_CASE("what is odd about a skeleton's file is reported") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const std::string clip = (pipeline.motion() / "walk_s02_01.bvh").string(),
                    track = (folder / "t.csv").string();
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --quiet", clip, track)).exit_code == 0);
  std::string text = mcdbn::read_text_file(clip);
  const auto frames = text.find("Frames: ");
  const auto end = text.find('\n', frames);
  const fs::path odd = folder.write("odd.bvh", text.replace(frames, end - frames, "Frames: 30"));
  check_warned(
      fmt::format("regenerate --model '{}' --input '{}' --skeleton '{}' -o '{}' --quiet",
                  pipeline.model().string(), track, odd.string(), (folder / "out.bvh").string()),
      odd.string());
}
