// Inputs at the edge of what there is to see: one frame, nothing that moves, nothing that was seen.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "mcdbn/camera/track_stretches.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// The first frame of one of the pipeline's clips, so many times.
fs::path still_clip(const ScratchFolder& folder, const std::string& name, int frames) {
  Motion motion = read_bvh(TinyPipeline::instance().motion() / "walk_s02_01.bvh");
  const RowVectorD first = motion.channels.row(0);
  motion.channels = first.replicate(frames, 1);
  write_bvh(folder / name, motion);
  return folder / name;
}

/// The lines of a track with every number behind the header gone.
std::string unseen(const std::string& track) {
  std::string result;
  int line = 0;
  for (const char c : track) {
    if (c == '\n') ++line;
    if (line < 2 || c == ',' || c == '\n') result += c;
  }
  return result;
}

void check_run(const std::string& arguments, int exit_code, const std::string& words = {}) {
  CAPTURE(arguments);
  const CliResult result = run_cli(arguments);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == exit_code);
  CHECK(result.standard_error.find(words) != std::string::npos);
}

}  // namespace

TEST_CASE("a clip of one frame is seen, drawn and answered; nothing is learnt or goes on from it") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string clip = still_clip(folder, "one.bvh", 1).string(),
                    track = (folder / "one.csv").string(), out = (folder / "out").string();
  const std::string model = TinyPipeline::instance().model().string();
  check_run("info " + clip, 0);
  check_run("project " + clip + " -o " + track, 0, "1 frame");
  check_run("render " + clip + " -o " + out + ".png", 0);
  check_run("regenerate --model " + model + " --input " + track + " -o " + out + ".bvh", 0);
  CHECK(read_bvh(out + ".bvh").frames() == 1);
  check_run("generate --model " + model + " --seed-clip " + clip + " -o " + out + "_2.bvh", 3,
            "one.bvh: the seed clip has 1 frame");
  check_run("train " + clip + " -o " + out + "_run --quiet", 2, "the longest clip has 1;");
  CHECK(!fs::exists(out + "_2.bvh"));
}

TEST_CASE("a clip in which nothing moves trains beside others, and its track is answered") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string clip = still_clip(folder, "still.bvh", 40).string(),
                    track = (folder / "still.csv").string(), run = (folder / "run").string(),
                    out = (folder / "out.bvh").string();
  check_run("project " + clip + " -o " + track, 0);
  check_run("train " + clip + " " + TinyPipeline::instance().training_clips() + " -o " + run +
                " --quiet --augment-views 4 " + kTinyGreedy +
                " --fine-tuning-steps 3 --fine-tuning-windows 4",
            0);
  check_run("regenerate --model " + run + "/model.safetensors --input " + track + " -o " + out, 0);
  const Motion answer = read_bvh(out);
  CHECK(answer.frames() == 40);
  CHECK(answer.channels.allFinite());
}

TEST_CASE("a track that shows no person is described, and refused by its name") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string whole = (folder / "whole.csv").string(), out = (folder / "out.bvh").string();
  check_run("project " + (pipeline.motion() / "walk_s02_01.bvh").string() + " -o " + whole, 0);
  const std::string none = folder.write("none.csv", unseen(read_text_file(whole))).string();
  const CliResult described = run_cli("info --json " + none);
  CHECK(described.exit_code == 0);
  CHECK(described.standard_output.find("\"people_seen\": 0") != std::string::npos);
  check_run("regenerate --model " + pipeline.model().string() + " --input " + none + " -o " + out,
            3, none + ": the 2D track never shows");
  CHECK(!fs::exists(out));
}

TEST_CASE("frames of a track that show nobody: regenerate reports which, and that it is made up") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string csv = (folder / "track.csv").string(), out = (folder / "out.bvh").string();
  check_run("project " + (pipeline.motion() / "walk_s02_01.bvh").string() + " -o " + csv, 0);
  Track2d track = read_track_csv(csv);
  const std::string call =
      "regenerate --model " + pipeline.model().string() + " --input " + csv + " -o " + out;
  CHECK(run_cli(call).standard_error.find("nobody") == std::string::npos);
  // Gaps of at most 0.2 s are interpolated.
  const int short_gap = static_cast<int>(0.2 * track.fps);
  REQUIRE(short_gap == 6);
  REQUIRE(track.frames() > 30);
  leave_out(track, {{0, 9}, {12, short_gap}, {22, short_gap + 1}});
  write_track_csv(csv, track);
  check_run(call, 0,
            "track.csv: nobody is seen in frames 0-8, 22-28: the motion there is made up\n");
}

TEST_CASE("a track that jumps to another person: info and regenerate report where") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const fs::path clip = TinyPipeline::instance().motion() / "walk_s02_01.bvh",
                 csv = folder / "track.csv", out = folder / "out.bvh";
  REQUIRE(run_cli(fmt::format("project {} -o {}", clip.string(), csv.string())).exit_code == 0);
  Track2d track = read_track_csv(csv);
  const int half = track.frames() / 2;
  REQUIRE(half > 12);
  track.x_px.bottomRows(track.frames() - half).array() += track.width_px;
  track.y_px.row(5).array() -= 2 * track.height_px;
  write_track_csv(csv, track);
  const auto described =
      nlohmann::json::parse(run_cli("info --json " + csv.string()).standard_output);
  CHECK(described.at("people")[0].at("jumps_to_frames") == nlohmann::json{half});
  const std::string model = TinyPipeline::instance().model().string();
  const std::string call =
      fmt::format("regenerate --model {} --input {} -o {}", model, csv.string(), out.string());
  check_run(
      call, 0,
      fmt::format("track.csv: jumps to another place or size, as if to another person or after "
                  "a cut: frames 0-{}, {}-{} are regenerated each by themselves",
                  half - 1, half, track.frames() - 1));
  check_run(call, 0, "track.csv: another person in frames 5: left out");
  CHECK(read_bvh(out).frames() == track.frames());
}
