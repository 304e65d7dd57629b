// Options that would be ignored, and outputs that could not be written: refused before the work.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

namespace refused_options_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// Its error has those words.
void check_error(const std::string& call, int exit_code, const std::string& words) {
  CAPTURE(call);
  const CliResult result = run_cli(call);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == exit_code);
  CHECK(result.standard_error.find(words) != std::string::npos);
}

/// The clip with a joint whose name no CSV header can hold.
fs::path with_odd_name(const fs::path& clip, const fs::path& path) {
  std::string text = mcdbn::read_text_file(clip);
  const std::string name = "JOINT LeftHand\n";
  const auto at = text.find(name);
  REQUIRE(at != std::string::npos);
  mcdbn::write_text_file(path, text.replace(at, name.size(), "JOINT Hand #1\n"));
  return path;
}

/// Which can only be refused for its other options: nothing that it names exists.
std::string regenerate(const std::string& options) {
  return "regenerate --model absent --input absent.csv -o out.bvh " + options;
}

}  // namespace

TEST_CASE("regenerate: a simpler method is not sampled") {
  for (const char* option :
       {"--samples 5", "--temperature 2", "--gibbs-steps 3", "--mrbm-gibbs-steps 1"}) {
    const std::string text = option, flag = text.substr(0, text.find(' '));
    check_error(regenerate("--method ridge_window " + text), 2,
                flag + " is for --method model: ridge_window gives a single answer");
  }
  if (!have_device()) return;
  // What asks for the single answer is not refused: the model is then missing.
  check_error(regenerate("--method mean_pose --samples 1 --temperature 0"), 3, "absent");
}

TEST_CASE("several samples are refused where nothing would be drawn") {
  if (!have_device()) return;
  const std::string model = TinyPipeline::instance().model().string();
  for (const std::string& command :
       {fmt::format("regenerate --model '{}' --input absent.csv -o out.bvh ", model),
        fmt::format("evaluate --model '{}' --baselines none --test absent.bvh ", model)}) {
    for (const char* options : {"--gibbs-steps 0", "--gibbs-steps 0 --mrbm-gibbs-steps 0",
                                "--temperature 0", "--temperature 0 --gibbs-steps 2"})
      check_error(command + "--samples 3 " + options, 2,
                  "--samples 3: all would be the mean-field answer");
    // One answer may be the mean-field one; and either kind of steps draws.
    for (const char* options :
         {"--samples 1 --gibbs-steps 0", "--samples 1 --temperature 0",
          "--samples 3 --gibbs-steps 0 --mrbm-gibbs-steps 1", "--samples 3 --gibbs-steps 1"})
      check_error(command + options, 3, "absent");
  }
}

TEST_CASE(
    "evaluate: the view of exact tracks is refused where a detector's cameras see the clips") {
  for (const char* option : {"--camera-azimuth", "--camera-elevation"})
    check_error(fmt::format("evaluate --model m --test t --tracks detector {} 30", option), 2,
                fmt::format("{} is for --tracks exact", option));
}

TEST_CASE("--write-camera: an ending that no camera format has is refused before the work") {
  const ScratchFolder folder;
  for (const char* name : {"cam.txt", "cam"}) {
    const std::string file = (folder / name).string();
    for (const std::string& command :
         {regenerate(""), std::string("project absent.bvh -o out.csv ")})
      check_error(fmt::format("{}--write-camera '{}'", command, file), 2,
                  fmt::format("--write-camera {}: give a .yml, .yaml, .xml or .json", file));
  }
  const fs::path clip = folder.write("clip.bvh", small_bvh(3)), camera = folder / "CAM.YML";
  CHECK(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}'", clip.string(),
                            (folder / "track.csv").string(), camera.string()))
            .exit_code == 0);
  CHECK(fs::exists(camera));
}

TEST_CASE("regenerate: a joint that no CSV header can name is refused before the work") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const std::string message = "joint name 'Hand #1' cannot stand in a CSV header";
  const fs::path clip = with_odd_name(pipeline.motion() / "walk_s01_01.bvh", folder / "odd.bvh"),
                 uncertainty = folder / "sure.csv", track = folder / "track.csv";
  check_error(fmt::format("regenerate --model '{}' --input absent.csv -o '{}' --skeleton '{}' "
                          "--uncertainty '{}'",
                          pipeline.model().string(), (folder / "out.bvh").string(), clip.string(),
                          uncertainty.string()),
              3, uncertainty.string() + ": " + message);
  REQUIRE(train(fmt::format("'{}'", clip.string()), folder / "run",
                kTinyGreedy + " --stages greedy --layers 1 --order 2 --quiet")
              .exit_code == 0);
  check_error(fmt::format("regenerate --model '{}' --to track --input absent.bvh -o '{}'",
                          (folder / "run/model.safetensors").string(), track.string()),
              3, track.string() + ": " + message);
}

}  // namespace refused_options_test
