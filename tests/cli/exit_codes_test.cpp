// What each exit code is for, in every command; and stopping by Ctrl-C.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

struct Case {
  std::string arguments;
  int exit_code;
  std::string words;  ///< in the one line on stderr
};

void check_case(const Case& one) {
  CAPTURE(one.arguments);
  const CliResult result = run_cli(one.arguments);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == one.exit_code);
  CHECK(result.standard_output.empty());
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: "));
  CHECK(result.standard_error.find(one.words) != std::string::npos);
}

/// Starts the program, waits until `sign` holds something, and interrupts it.
CliResult interrupted_after(const fs::path& sign, const std::string& arguments) {
  const ScratchFolder folder;
  const fs::path script = folder.write(
      "interrupt.sh", fmt::format("'{}' {} & program=$!\n"
                                  "while kill -0 $program 2>/dev/null && [ ! -s '{}' ]; do\n"
                                  "  sleep 0.05\ndone\n"
                                  "kill -INT $program 2>/dev/null\nwait $program\n",
                                  MCDBN_CLI, arguments, sign.string()));
  return run_program("/bin/sh", fmt::format("'{}'", script.string()));
}

}  // namespace

TEST_CASE("exit codes: usage 2, input 3, without any device") {
  const ScratchFolder folder;
  const std::string clip = folder.write("clip.bvh", small_bvh(8)).string();
  const std::string text = folder.write("text.bvh", "hello\n").string();
  const std::string out = (folder / "out").string();
  for (const Case& one : std::vector<Case>{
           {"synthesize --action walk --clips 0 -o " + out, 2, "--clips"},
           {"synthesize --action walk --seconds -1 -o " + out, 2, "seconds"},
           {"synthesize --action walk --fps 0 -o " + out, 2, "fps"},
           {"synthesize --action walk --clips 1 --seconds 0.5 -o " + clip, 3, clip},
           {"project " + text + " -o " + out, 3, text},
           {"project " + clip + " -o " + out + " --camera " + text, 3, text},
           {"project " + clip + " -o " + out + " --camera-elevation 90", 2, "--camera-elevation"},
           {"project " + clip + " -o " + out + " --noise-px -1", 2, "--noise-px"},
           {"render " + text + " -o " + out + ".png", 3, text},
           {"render " + clip + " -o " + out + ".png --columns 0", 2, "column"},
           {"info " + text, 3, text},
           {"info absent.csv", 3, "absent.csv"},
           {"train absent -o " + out, 3, "absent"},
           {"project " + clip + " -o " + out + " --camera-fov 180", 2, "--camera-fov"},
           {"project " + clip + " -o " + out + " --seed -1", 2, "--seed"},
           {"train " + clip + " -o " + out + " --hidden 0", 2, "--hidden must be at least 1"},
           {"train " + clip + " -o " + out + " --hidden -3", 2, "--hidden"},
           {"train " + clip + " -o " + out + " --hidden 2.5", 2, "--hidden"},
           {"train " + clip + " -o " + out + " --fps fast", 2, "--fps"},
           {"train " + clip + " -o " + out + " --joint-rate 0", 2, "--joint-rate"},
           {"train " + clip + " -o " + out + " --gaussian-rate-A -1", 2, "--gaussian-rate-A"},
           {"train " + clip + " -o " + out + " --camera-fov 180", 2, "--camera-fov"},
           {"train " + clip + " -o " + out + " --fine-tuning-dropout 1", 2,
            "--fine-tuning-dropout must be at least 0 and below 1, not 1"},
           {"regenerate --quiet --input t.csv -o " + out, 3, "t.csv: no such file"},
           {"regenerate --quiet --input t.csv -o " + out + ".BVH", 3, "t.csv: no such file"},
           {"regenerate --model m --input t.csv -o " + out + ".fbx", 2, "use .bvh"},
           {"regenerate --model m --to track --input c.bvh -o " + out + ".bvh", 2, "use .csv"},
           {"generate --model m --seed-clip c.bvh -o " + out + ".csv", 2, "use .bvh"},
           {"evaluate --model m", 2, "--test"},
           {"evaluate --model m --test t --camera-elevation -89.05", 2, "--camera-elevation"},
           {"evaluate --model m --test t --camera-elevation 90", 2, "--camera-elevation"},
           {"evaluate --model m --test t --track-missing 1.5", 2, "--track-missing"},
           {"bench --seconds 601", 2, "--seconds"},
           {"devices surplus", 2, "not expected: surplus"},
           {"--odd devices", 2, "not expected: --odd"}})
    check_case(one);
  CHECK(!fs::exists(out));
  CHECK(!fs::exists(out + ".png"));
}

TEST_CASE("exit codes: numbers out of any range are 2, NaN is in none, messages are short") {
  const ScratchFolder folder;
  const std::string clip = folder.write("clip.bvh", small_bvh(8)).string();
  const std::string out = (folder / "out").string();
  const std::string grid =
      folder
          .write("sweep.toml",
                 [] {
                   std::string text = "test = ['t']\n[grid]\n";
                   for (const char* name :
                        {"seed", "order", "hidden", "batch", "phases", "fps", "layers"})
                     text += fmt::format("{} = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n", name);
                   return text;
                 }())
          .string();
  const std::string last_impossible =
      folder.write("impossible.toml", "test = ['t']\n[grid]\norder = [1, 5000]\n").string();
  const std::string project = "project " + clip + " -o " + out,
                    train = "train " + clip + " -o " + out,
                    render = "render " + clip + " -o " + out + ".png",
                    regenerate = "regenerate --model m --input t.csv -o " + out,
                    generate = "generate --model m --seed-clip c.bvh -o " + out;
  for (const Case& one : std::vector<Case>{
           {project + " --fps 1e-300", 2,
            "--fps, if not 0, must be at least 0.1 and at most 10000"},
           {render + " --fps 1e-300", 2, "--fps"},
           {render + " --fps 1e9", 2, "--fps: must be at least 0 and at most 10000, not '1e9'"},
           {project + " --fps nan", 2, "--fps: must be at least 0"},
           {project + " --fps inf", 2, "--fps: must be at least 0"},
           {project + " --camera-distance nan", 2, "--camera-distance: must be above 0"},
           {project + " --image-size 1000000000 5", 2, "--image-size: must be at least 1"},
           {project + " --image-size -1 5", 2, "--image-size: must be at least 1"},
           {project + " --noise-px 1e300", 2, "--noise-px"},
           {render + " --orbit-speed nan", 2, "--orbit-speed"},
           {render + " --video-fps nan", 2, "--video-fps: must be at least 1 and at most 240"},
           {render + " --over-from -1", 2, "--over-from"},
           {regenerate + " --temperature nan", 2,
            "--temperature: must be at least 0 and at most 10"},
           {regenerate + " --samples nan", 2, "--samples"},
           {regenerate + " --fps 1e-9", 2, "--fps: must be at least 0.1 and at most 10000"},
           {generate + " --temperature nan", 2, "--temperature"},
           {generate + " --frames 1e300", 2, "--frames: must be at least 1 and at most 1000000"},
           {"bench --seconds nan", 2, "--seconds"},
           {"synthesize --action walk --clips 1000000000 -o " + out, 2, "--clips"},
           {train + " --seed -1", 2, "--seed must be at least 0"},
           {train + " --seed 18446744073709551615", 2,
            "--seed must be at least 0 and at most 9e+18"},
           {train + " --layers 100000", 2, "--layers must be at least 1 and at most 64"},
           {train + " --hidden 1000000000", 2, "--hidden must be at least 1 and at most 100000"},
           {train + " --order -1", 2, "--order must be at least 0 and at most 1000"},
           {train + " --augment-speed nan", 2, "--augment-speed must be"},
           {train + " --augment-bone 1e300", 2, "--augment-bone must be"},
           {train + " --gaussian-rate 1e300", 2, "--gaussian-rate must be above 0 and at most 100"},
           {train + " --fine-tuning-windows 1000000000", 2, "--fine-tuning-windows must be"},
           {train + " --phases 1e9", 2, "--phases must be a whole number"},
           {train + " --sweep " + grid, 2, "10000000 configurations; a sweep has 10000 at most"},
           {train + " --sweep " + last_impossible, 2,
            "impossible.toml:3: order must be at least 0 and at most 1000"}}) {
    check_case(one);
    CHECK(run_cli(one.arguments).standard_error.size() < 300 + out.size());
  }
  CHECK(!fs::exists(out));
}

TEST_CASE("exit codes: a file's own words are not repeated by the kilobyte") {
  const ScratchFolder folder;
  const std::string name(100000, 'x');
  const fs::path list =
      folder.write("list.toml", "[[clip]]\nfile = \"" + name + ".bvh\"\nperson = \"a\"\n");
  const CliResult result = run_cli(fmt::format("corpus '{}'", list.string()));
  CHECK(result.exit_code == 3);
  CAPTURE(result.standard_error.substr(0, 300));
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: " + list.string()));
  CHECK(result.standard_error.find(": no such file: ") < 200);
  CHECK(result.standard_error.size() < 5000);
}

TEST_CASE("exit codes: a film that is cut off is 3, in one line of our own words") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(40)), film = folder / "film.mp4",
                 camera = folder / "c.yaml", track = folder / "t.csv";
  REQUIRE(
      run_cli(fmt::format("render '{}' -o '{}' --image-size 96 96", clip.string(), film.string()))
          .exit_code == 0);
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}'", clip.string(),
                              track.string(), camera.string()))
              .exit_code == 0);
  const std::string whole = mcdbn::read_text_file(film);
  const fs::path cut = folder.write("cut.mp4", whole.substr(0, whole.size() / 2));
  const CliResult result =
      run_cli(fmt::format("render '{}' -o '{}' --over '{}' --camera '{}'", clip.string(),
                          (folder / "o.mp4").string(), cut.string(), camera.string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.ends_with(
      fmt::format("mcdbn-cl: error: {}: is not a film that can be read\n", cut.string())));
  for (const char* raw : {"OpenCV(", "exception", "[mov", "GStreamer"})
    CHECK(result.standard_error.find(raw) == std::string::npos);
}

TEST_CASE("exit codes: what a training cannot do with these clips or this device is 2, at once") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const std::string train = "train " + pipeline.training_clips() + " --quiet --force -o '" +
                            (folder / "run").string() + "' ";
  for (const Case& one : std::vector<Case>{
           {train + "--order 100", 2, "--order 100"},
           {train + "--order 40", 2, "but the longest clip has 36"},
           {train + "--look-ahead 500", 2, "a window of 511 frames"},
           {train + "--hidden 100000 --mrbm-hidden 100000", 2, "lower --hidden (now 100000)"},
           {train + "--fine-tuning-windows 100000 --fine-tuning-window-frames 1000", 2,
            "--fine-tuning-windows (100000)"}})
    check_case(one);
  CHECK(!fs::exists(folder / "run/model.safetensors"));
}

TEST_CASE("exit codes: bad models and tracks are 3, no such device 4") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const std::string text = folder.write("text.csv", "hello\n").string();
  const std::string model = pipeline.model().string();
  const std::string clip = (pipeline.motion() / "walk_s02_01.bvh").string();
  const std::string out = (folder / "out.bvh").string();
  for (const Case& one : std::vector<Case>{
           {"regenerate --model " + text + " --input " + text + " -o " + out, 3, text},
           {"regenerate --model " + model + " --input " + text + " -o " + out, 3, text},
           {"regenerate --model " + model + " --input t.csv -o " + out + " --camera no.yaml", 3,
            "no.yaml"},
           {"regenerate --model " + model + " --input t.csv -o " + out + " --skeleton no.bvh", 3,
            "no.bvh"},
           {"evaluate --model absent --test " + clip, 3, "absent"},
           {"evaluate --model " + model + " --test absent.bvh", 3, "absent.bvh"},
           {"evaluate --model " + model + " --test " + clip + " --device no-such", 4, "no-such"},
           {"train " + clip + " --quiet -o '" + text + "/run'", 3,
            text + "/run: the folder cannot be made: "},
           {"bench --platform no-such", 4, "no-such"}})
    check_case(one);
  CHECK(!fs::exists(out));
}

TEST_CASE("exit codes: a skeleton or joint map that cannot be used is named, and not the track") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  std::string text = small_bvh(8);
  for (const char* joint : {"Hips", "Chest"}) text.replace(text.find(joint), 5, "Stick");
  const std::string stick = folder.write("stick.bvh", text).string(),
                    map = folder.write("map.toml", "left_knee = \"Nobody\"\n").string(),
                    track = (folder / "t.csv").string();
  REQUIRE(run_cli(fmt::format("project '{}' -o {}",
                              (pipeline.motion() / "walk_s02_01.bvh").string(), track))
              .exit_code == 0);
  const std::string input = "--model " + pipeline.model().string() + " --input " + track,
                    out = " -o " + (folder / "out.bvh").string();
  const auto check_named = [](const std::string& arguments, const std::string& words) {
    CAPTURE(arguments);
    const CliResult result = run_cli(arguments);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 3);
    CHECK(result.standard_error.find("error: " + words) != std::string::npos);
  };
  check_named("regenerate " + input + out + " --skeleton " + stick,
              stick + ": a skeleton without a known pelvis");
  const std::string of_map = map + ": left_knee is to be the joint Nobody";
  check_named("regenerate " + input + out + " --joint-map " + map, of_map);
  check_named("regenerate --follow " + input + " --joint-map " + map, of_map);
}

TEST_CASE("Ctrl-C: training stops with 130, what is unfinished, and no model") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run", metrics = run / "unfinished/metrics.jsonl";
  const std::string small = "--hidden 8 --mrbm-hidden 8 --stages greedy --layers 1";
  const CliResult result = interrupted_after(
      metrics, fmt::format("train {} -o '{}' {} --quiet --gaussian-epochs 1000000",
                           pipeline.training_clips(), run.string(), small));
  CHECK(result.exit_code == 130);
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: interrupted; "));
  CHECK(!fs::exists(run / "model.safetensors"));
  CHECK(fs::exists(run / "unfinished/config.toml"));
  CHECK(mcdbn::read_text_file(metrics).ends_with("}\n"));

  // A sweep stops too, instead of going on with the next configuration.
  const fs::path sweep =
      folder.write("sweep.toml", fmt::format("test = ['{}']\n[grid]\nseed = [1, 2]\n",
                                             (pipeline.motion() / "walk_s02_01.bvh").string()));
  const CliResult swept = interrupted_after(
      folder / "swept/seed=1/unfinished/metrics.jsonl",
      fmt::format("train {} -o '{}' {} --gaussian-epochs 2 --mrbm-epochs 1000000 --sweep '{}'",
                  pipeline.training_clips(), (folder / "swept").string(), small, sweep.string()));
  CHECK(swept.exit_code == 130);
  CHECK(!fs::exists(folder / "swept/seed=2"));
  CHECK(!fs::exists(folder / "swept/sweep.jsonl"));
}
