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
           {"regenerate --input t.csv -o " + out, 2, "--model"},
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

TEST_CASE("Ctrl-C: training stops with 130, the metrics so far, and no model") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run", metrics = run / "metrics.jsonl";
  const std::string small = "--hidden 8 --mrbm-hidden 8 --stages greedy --layers 1";
  const CliResult result = interrupted_after(
      metrics, fmt::format("train {} -o '{}' {} --quiet --gaussian-epochs 1000000",
                           pipeline.training_clips(), run.string(), small));
  CHECK(result.exit_code == 130);
  CHECK(result.standard_error == "mcdbn-cl: error: interrupted\n");
  CHECK(!fs::exists(run / "model.safetensors"));
  CHECK(fs::exists(run / "config.toml"));
  CHECK(mcdbn::read_text_file(metrics).ends_with("}\n"));

  // A sweep stops too, instead of going on with the next configuration.
  const fs::path sweep =
      folder.write("sweep.toml", fmt::format("test = ['{}']\n[grid]\nseed = [1, 2]\n",
                                             (pipeline.motion() / "walk_s02_01.bvh").string()));
  const CliResult swept = interrupted_after(
      folder / "swept/seed=1/metrics.jsonl",
      fmt::format("train {} -o '{}' {} --gaussian-epochs 2 --mrbm-epochs 1000000 --sweep '{}'",
                  pipeline.training_clips(), (folder / "swept").string(), small, sweep.string()));
  CHECK(swept.exit_code == 130);
  CHECK(!fs::exists(folder / "swept/seed=2"));
  CHECK(!fs::exists(folder / "swept/sweep.jsonl"));
}
