// regenerate --follow: a track that is still being written, and frames as they are finished.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/text_file.hpp"
#include "follow_scene.hpp"
#include "library_calls.hpp"
#include "mcdbn/camera/track_stretches.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/frame_stream.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/motion_model/live_regeneration.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// What the library makes of the track, as that stream writes it.
std::string by_library(const FollowScene& scene, const std::string& frames,
                       std::optional<std::size_t> look_ahead = {}) {
  const mcdbn::Model model = load_model(usual_device(), TinyPipeline::instance().model());
  mcdbn::ClipPlacement placement;
  placement.camera = mcdbn::read_camera(scene.camera);
  const mcdbn::Track2d track = mcdbn::read_track_csv(scene.track);
  mcdbn::LiveRegeneration live(model, track, placement, look_ahead);
  std::stringstream out;
  const auto stream = frames == "csv"    ? mcdbn::csv_stream(out, track.fps)
                      : frames == "json" ? mcdbn::json_stream(out, track.fps)
                                         : mcdbn::bvh_stream(out, track.fps, true);
  const auto write = [&](const std::vector<mcdbn::LiveFrame>& finished) {
    for (const mcdbn::LiveFrame& frame : finished)
      stream->write(live.skeleton(), frame.channels, frame.seen);
  };
  for (int t = 0; t < track.frames(); ++t)
    write(live.push({track.x_px.row(t), track.y_px.row(t), track.confidence.row(t)}));
  write(live.finish());
  stream->finish();
  return out.str();
}

}  // namespace

TEST_CASE("regenerate --follow: a piped track as the library follows it, in every form of frames") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path out = scene.folder / "out.bvh";
  const CliResult result = scene.follow(fmt::format("-o '{}'", out.string()), scene.track);
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(result.standard_output.empty());
  CHECK(mcdbn::read_text_file(out) == by_library(scene, "bvh"));
  CHECK(mcdbn::read_bvh(out).frames() == mcdbn::read_track_csv(scene.track).frames());
  CHECK(scene.follow("--quiet --frames csv", scene.track).standard_output ==
        by_library(scene, "csv"));
  const CliResult causal = run_cli(scene.call(
      fmt::format("--quiet --frames json --look-ahead 0 --input '{}'", scene.track.string())));
  CHECK(causal.standard_output == by_library(scene, "json", 0));
  CHECK(causal.standard_output != by_library(scene, "json"));
  // By the ending, too.
  REQUIRE(scene.follow(fmt::format("-o '{}'", (scene.folder / "out.jsonl").string()), scene.track)
              .exit_code == 0);
  CHECK(mcdbn::read_text_file(scene.folder / "out.jsonl") == by_library(scene, "json"));
}

TEST_CASE(
    "regenerate --follow: frames come while the track is written; Ctrl-C leaves a whole file") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path out = scene.folder / "out.bvh";
  // 30 frames, then nothing until all but the last 8 are there (look-ahead and 3), then Ctrl-C.
  const CliResult result = scene.follow_pipe(
      out, fmt::format("head -n 32 '{}' >&3\n"
                       "for ((i = 0; i < 3000; ++i)); do\n"
                       "  lines=$(sed '1,/Frame Time/d' '{}' 2>/dev/null | wc -l)\n"
                       "  (( lines >= 22 )) && {{ echo came; break; }}; sleep 0.02\ndone\n"
                       "kill -INT $program\n",
                       scene.track.string(), out.string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_output == "came\n");
  std::vector<std::string> warnings;
  const mcdbn::Motion motion = mcdbn::read_bvh(out, &warnings);
  CHECK(motion.frames() == 30);
  CHECK(warnings.empty());
}

TEST_CASE("regenerate --follow: what is inferred or assumed is reported, as of a whole track") {
  if (!have_device()) return;
  const FollowScene scene;
  const std::string model = TinyPipeline::instance().model().string(),
                    out = (scene.folder / "out.bvh").string();
  const auto reported = [&](const fs::path& track, const std::string& options) {
    const CliResult result =
        run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' --quiet {}", model,
                            track.string(), out, options));
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return result.standard_error;
  };
  const auto inferred = [](const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line) && !line.ends_with(" are never seen: inferred")) line.clear();
    return line;
  };
  // All of the model's joints but one, by name, and a detector's keypoints.
  mcdbn::Track2d track = mcdbn::read_track_csv(scene.track);
  const mcdbn::Model loaded = load_model(usual_device(), model);
  const std::string& last = loaded.modalities.track_features.joint_names().back();
  const int left_out = track.find(last);
  REQUIRE(left_out >= 0);
  track.joint_names[static_cast<std::size_t>(left_out)] = "elsewhere";
  write_track_csv(scene.folder / "joints.csv", track);
  const fs::path lines = scene.folder.write("lines.jsonl", scene.detected_lines());
  const std::string image = "--image-size 1920 1080";
  for (const fs::path& input : {scene.folder / "joints.csv", lines}) {
    CAPTURE(input.string());
    const std::string live = reported(input, "--follow " + image), whole = reported(input, image);
    REQUIRE(!inferred(whole).empty());
    CHECK(inferred(live) == inferred(whole));
    CHECK(live.find("no --camera: assumed to look down by ") != std::string::npos);
  }
  CHECK(inferred(reported(scene.folder / "joints.csv", image)).find(last) != std::string::npos);
  // Of a whole body and a known camera there is nothing to report.
  CHECK(reported(scene.track, fmt::format("--follow --camera '{}'", scene.camera.string())) == "");
}

TEST_CASE("regenerate --follow: a broken line is named and counts as a frame without anybody") {
  if (!have_device()) return;
  const FollowScene scene;
  std::string text = mcdbn::read_text_file(scene.track);
  std::size_t at = 0;
  for (int line = 1; line < 12; ++line) at = text.find('\n', at) + 1;
  text.insert(at, "1,2,three\n");
  const fs::path broken = scene.folder.write("broken.csv", text);
  const CliResult result = scene.follow("--frames csv", broken);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_error.find("standard input:12: 3 cells") != std::string::npos);
  // The frame that was broken, and the header.
  CHECK(count_lines(result.standard_output) == mcdbn::read_track_csv(scene.track).frames() + 2);
}

TEST_CASE("regenerate --follow: a track that shows too little is refused by its name") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path hips = scene.folder.write("hips.csv", "Hips_x_px,Hips_y_px\n10,20\n11,21\n");
  CHECK(scene.follow("", hips).standard_error.find(
            "error: standard input: the 2D track shows too little of the body") !=
        std::string::npos);
  const CliResult result = run_cli(scene.call(fmt::format("--input '{}'", hips.string())));
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find(
            fmt::format("error: {}: the 2D track shows too little of the body", hips.string())) !=
        std::string::npos);
}

TEST_CASE("regenerate --follow: a reader that closes the pipe ends it") {
  if (!have_device()) return;
  const FollowScene scene;
  // The track goes on for as long as it is read.
  const fs::path script = scene.folder.write(
      "closed.sh",
      fmt::format("(head -n 2 '{0}'; while tail -n +3 '{0}' 2>/dev/null; do :; done) |\n"
                  "  '{1}' {2} --quiet --frames csv | head -n 3 | wc -l\n"
                  "exit ${{PIPESTATUS[1]}}\n",
                  scene.track.string(), MCDBN_CLI, scene.call("")));
  const CliResult result = run_program("/bin/bash", fmt::format("'{}'", script.string()));
  CAPTURE(result.standard_error);
  CHECK(result.standard_output == "3\n");
  CHECK(result.exit_code == 128 + SIGPIPE);
  CHECK(result.standard_error.find("error") == std::string::npos);
}

TEST_CASE("regenerate --follow: an output that cannot be written is named, no frame is blamed") {
  if (!have_device()) return;
  const FollowScene scene;
  const CliResult full = run_program(
      "/bin/bash",
      fmt::format("-c \"'{}' {} > /dev/full\"", MCDBN_CLI,
                  scene.call(fmt::format("--quiet --input '{}'", scene.track.string()))));
  CAPTURE(full.standard_error);
  CHECK(full.exit_code == 3);
  CHECK(full.standard_error.find("error: standard output: a frame cannot be written") !=
        std::string::npos);
  CHECK(full.standard_error.find("shows no person") == std::string::npos);
  fs::create_directory(scene.folder / "folder");
  const CliResult folder = run_cli(scene.call(fmt::format(
      "--input '{}' -o '{}'", scene.track.string(), (scene.folder / "folder").string())));
  CHECK(folder.exit_code == 3);
  // What is read is not written over, by whatever name.
  const std::string before = mcdbn::read_text_file(scene.camera);
  fs::create_hard_link(scene.camera, scene.folder / "other.bvh");
  CHECK(run_cli(scene.call(fmt::format("--input '{}' -o '{}'", scene.track.string(),
                                       (scene.folder / "other.bvh").string())))
            .exit_code == 3);
  CHECK(mcdbn::read_text_file(scene.camera) == before);
}

TEST_CASE("regenerate --follow: a person by number who never comes is exit code 3") {
  if (!have_device()) return;
  const FollowScene scene;
  // Of our CSV, which has one person, and of a detector's frames, a line each.
  const std::string lines = scene.detected_lines();
  for (const fs::path& track : {scene.track, scene.folder.write("lines.jsonl", lines)}) {
    CAPTURE(track.string());
    const CliResult second = scene.follow("--person 2 --quiet --frames json", track);
    CHECK(second.exit_code == 3);
    CHECK(second.standard_error.find("error: standard input: no person 2 in any frame") !=
          std::string::npos);
    // The frames are there all the same.
    std::istringstream frames(second.standard_output);
    int count = 0;
    for (std::string line; std::getline(frames, line); ++count)
      CHECK(nlohmann::json::parse(line).at("seen") == false);
    CHECK(count == mcdbn::read_track_csv(scene.track).frames());
    const CliResult first = scene.follow("--person 1 --quiet --frames json", track);
    CHECK(first.exit_code == 0);
    CHECK(first.standard_output.find("\"seen\":true") != std::string::npos);
  }
}

TEST_CASE(
    "regenerate --follow: a track in which nobody is seen gives the mean pose and a warning") {
  if (!have_device()) return;
  const FollowScene scene;
  mcdbn::Track2d track = mcdbn::read_track_csv(scene.track);
  const auto warned = [&](Eigen::Index hidden) {
    leave_out(track, {{0, static_cast<int>(hidden)}});
    write_track_csv(scene.folder / "hidden.csv", track);
    const CliResult result = scene.follow("--quiet --frames csv", scene.folder / "hidden.csv");
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    CHECK(count_lines(result.standard_output) == track.frames() + 1);
    return result.standard_error.find("no frame shows enough of a person") != std::string::npos;
  };
  CHECK(!warned(track.frames() / 2));
  CHECK(warned(track.frames()));
}

TEST_CASE("regenerate --follow: the output's ending is that of a format of frames") {
  if (!have_device()) return;
  const FollowScene scene;
  const auto call = [&](const std::string& name, const std::string& options) {
    return run_cli(scene.call(fmt::format("--input '{}' -o '{}' --quiet {}", scene.track.string(),
                                          (scene.folder / name).string(), options)));
  };
  const CliResult refused = call("out.fbx", "");
  CHECK(refused.exit_code == 2);
  CHECK(refused.standard_error.find(".bvh, .csv, .json, .jsonl") != std::string::npos);
  CHECK(!fs::exists(scene.folder / "out.fbx"));
  CHECK(call("out.txt", "--frames csv").exit_code == 0);
  CHECK(call("out", "").exit_code == 0);
  CHECK(mcdbn::read_text_file(scene.folder / "out").starts_with("HIERARCHY"));
}

TEST_CASE("regenerate --follow: what cannot be followed") {
  if (!have_device()) return;
  const FollowScene scene;
  for (const char* other :
       {"--samples 2", "--fit none", "--to track", "--method mean_pose", "--write-camera c.yml",
        "--uncertainty u.csv", "--temperature 0.5", "--gibbs-steps 1", "--mrbm-gibbs-steps 1",
        "--look-ahead 100", "--person all", "--frames film"}) {
    CAPTURE(other);
    CHECK(scene.follow(other, scene.track).exit_code == 2);
  }
  const std::string plain = fmt::format("regenerate --model '{}' --input '{}' -o '{}'",
                                        TinyPipeline::instance().model().string(),
                                        scene.track.string(), (scene.folder / "o.bvh").string());
  CHECK(run_cli(plain + " --look-ahead 0").exit_code == 2);
  CHECK(run_cli(plain + " --frames csv").exit_code == 2);
  const CliResult empty = scene.follow("", scene.folder.write("empty.csv", ""));
  CHECK(empty.exit_code == 3);
  CHECK(empty.standard_error.find("no frame that shows a person") != std::string::npos);
  const CliResult header = scene.follow("", scene.folder.write("bad.csv", "1,2,3\n4,5,6\n"));
  CHECK(header.exit_code == 3);
  CHECK(header.standard_error.find("standard input:1: numbers where the header is expected") !=
        std::string::npos);
}
