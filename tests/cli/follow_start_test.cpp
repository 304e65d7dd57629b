// regenerate --follow before the first person comes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "follow_scene.hpp"
#include "library_calls.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/motion_model/live_regeneration.hpp"

namespace follow_start_test {

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kNobody = "{\"people\": []}\n";
constexpr const char* kBroken = "{\"people\": [\n";
constexpr const char* kLog = "INFO: warming up\n";

std::vector<json> frames_in(const std::string& lines) {
  std::vector<json> frames;
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);) frames.push_back(json::parse(line));
  return frames;
}

/// Channels of the frame that stands for nobody.
json nobody(const FollowScene& scene) {
  const mcdbn::Model model = load_model(usual_device(), TinyPipeline::instance().model());
  mcdbn::ClipPlacement placement;
  placement.camera = mcdbn::read_camera(scene.camera);
  const mcdbn::Motion pose = mcdbn::LiveRegeneration::before_anybody(model, placement);
  return std::vector<double>(pose.channels.row(0).begin(), pose.channels.row(0).end());
}

}  // namespace

TEST_CASE("regenerate --follow: JSON frames before the first person are written as they come") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path out = scene.folder / "out.jsonl";
  // The input stays open until the frames are there.
  const CliResult result = scene.follow_pipe(
      out, fmt::format("for i in 1 2 3 4 5; do echo '{{\"people\": []}}' >&3; done\n"
                       "for ((i = 0; i < 3000; ++i)); do\n"
                       "  (( $(cat '{}' 2>/dev/null | wc -l) == 5 )) && {{ echo came; "
                       "break; }}; sleep 0.02\ndone\n"
                       "exec 3>&-\n",
                       out.string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_output == "came\n");
  CHECK(result.standard_error.find("no frame shows enough of a person") != std::string::npos);
  const std::vector<json> frames = frames_in(mcdbn::read_text_file(out));
  REQUIRE(frames.size() == 5);
  const json expected = nobody(scene);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    CHECK(frames[t].at("frame") == t);
    CHECK(frames[t].at("seen") == false);
    CHECK(frames[t].at("channels") == expected);
  }
}

TEST_CASE("regenerate --follow: broken lines before the first person are more frames of nobody") {
  if (!have_device()) return;
  const FollowScene scene;
  const std::string person = scene.detected_lines();
  const CliResult result = scene.follow(
      "--frames json",
      scene.folder.write("late.jsonl", std::string(kNobody) + kNobody + kLog + kBroken + person));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  for (const char* line : {"standard input:3:", "standard input:4:"})
    CHECK(result.standard_error.find(line) != std::string::npos);
  CHECK(result.standard_error.find("taken as a frame that shows no person") != std::string::npos);
  const std::vector<json> frames = frames_in(result.standard_output),
                          alone = frames_in(scene
                                                .follow("--quiet --frames json",
                                                        scene.folder.write("alone.jsonl", person))
                                                .standard_output);
  constexpr std::size_t kBefore = 4;
  REQUIRE(!alone.empty());
  REQUIRE(frames.size() == kBefore + alone.size());
  const json expected = nobody(scene);
  for (std::size_t t = 0; t < kBefore; ++t) {
    CHECK(frames[t].at("seen") == false);
    CHECK(frames[t].at("channels") == expected);
  }
  for (std::size_t t = 0; t < alone.size(); ++t) {
    CHECK(frames[kBefore + t].at("frame") == kBefore + t);
    CHECK(frames[kBefore + t].at("seen") == alone[t].at("seen"));
    CHECK(frames[kBefore + t].at("channels") == alone[t].at("channels"));
  }
  // Before any frame it may be no track at all.
  const CliResult first = scene.follow(
      "--frames json", scene.folder.write("broken.jsonl", std::string(kBroken) + person));
  CHECK(first.exit_code == 3);
  CHECK(first.standard_error.find("error: standard input:1:") != std::string::npos);
}

TEST_CASE("regenerate --follow: a person whose image's size nothing gives is refused at once") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path lines =
      scene.folder.write("late.jsonl", std::string(kNobody) + kNobody + scene.detected_lines());
  const CliResult result = run_program(
      "/bin/bash",
      fmt::format("-c \"cat '{}' | '{}' regenerate --follow --model '{}' --quiet "
                  "--frames json\"",
                  lines.string(), MCDBN_CLI, TinyPipeline::instance().model().string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find("error: standard input:3: ") != std::string::npos);
  CHECK(result.standard_error.find("--image-size") != std::string::npos);
}

TEST_CASE("regenerate --follow: a stop before anything came is exit code 0 and leaves no file") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path out = scene.folder / "out.bvh";
  // The pipe can be opened for writing once the program has opened it.
  const CliResult result = scene.follow_pipe(out, "kill -INT $program\n");
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_error.find("stopped before the first frame") != std::string::npos);
  CHECK(!fs::exists(out));
}

TEST_CASE("regenerate --follow: a pipe whose writer writes nothing ends") {
  if (!have_device()) return;
  const FollowScene scene;
  const fs::path script = scene.folder.write(
      "silent.sh",
      fmt::format("mkfifo '{0}/pipe'\ntimeout 60 '{1}' {2} --input '{0}/pipe' & program=$!\n"
                  "timeout 60 bash -c \": > '{0}/pipe'\"\nwait $program\nexit $?\n",
                  (scene.folder / ".").string(), MCDBN_CLI, scene.call("--quiet")));
  const CliResult result = run_program("/bin/bash", fmt::format("'{}'", script.string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find("no frame that shows a person") != std::string::npos);
}

}  // namespace follow_start_test
