// Ctrl-C is heard within a second, whatever the program does, and leaves nothing behind.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

struct Stopped {
  int exit_code = -1;
  double took_s = 0;  ///< from the signal on
};

/// Starts a command that would take long, signals it after a while.
Stopped stopped(const std::string& arguments, double after_s, const std::string& signal = "INT",
                const std::string& environment = "") {
  const ScratchFolder folder;
  // A shell that is no terminal's starts programs deaf to Ctrl-C until they listen by themselves.
  const fs::path script = folder.write(
      "stop.sh",
      fmt::format("{} '{}' {} 2>/dev/null >/dev/null & program=$!\n"
                  "heeded=0; until (( heeded & 2 )) || ! kill -0 $program; do sleep 0.02\n"
                  "heeded=$((16#$(sed -n 's/SigBlk:\\t//p' /proc/$program/status))); done\n"
                  "sleep {}\nstart=$(date +%s%N)\nkill -{} $program\nwait $program\ncode=$?\n"
                  "echo $(( $(date +%s%N) - start ))\nexit $code\n",
                  environment, MCDBN_CLI, arguments, after_s, signal));
  const CliResult result = run_program("/bin/bash", fmt::format("'{}'", script.string()));
  return {result.exit_code, std::strtod(result.standard_output.c_str(), nullptr) * 1e-9};
}

void check_stopped(const std::string& arguments, double after_s) {
  CAPTURE(arguments);
  const Stopped result = stopped(arguments, after_s);
  CHECK(result.exit_code == 130);
  CHECK(result.took_s < 1.0);
}

}  // namespace

TEST_CASE("commands without a device stop at once and leave nothing") {
  const ScratchFolder folder, output;
  const std::string clip = folder.write("clip.bvh", small_bvh(5000)).string();
  check_stopped(fmt::format("synthesize --action walk --clips 100000 --seconds 5 -o '{}'",
                            (output / "clips").string()),
                0.3);
  check_stopped(fmt::format("render '{}' -o '{}'", clip, (output / "film.mp4").string()), 0.5);
  CHECK(fs::is_empty(output / ""));
}

TEST_CASE("in the middle of an epoch, and of a long run of samples") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder output;
  // One epoch takes minutes.
  check_stopped(fmt::format("train {} -o '{}' --stages greedy --hidden 256 --gaussian-epochs 1 "
                            "--least-batches 4000 --batch 50",
                            pipeline.training_clips(), (output / "run").string()),
                1.5);
  check_stopped(
      fmt::format("generate --model '{}' --seed-clip '{}' -o '{}' --frames 1000000",
                  pipeline.model().string(), (pipeline.motion() / "walk_s01_01.bvh").string(),
                  (output / "out.bvh").string()),
      1.5);
  CHECK(!fs::exists(output / "out.bvh"));
}

TEST_CASE("a second signal ends the program at once, with the same exit code") {
  const ScratchFolder folder, output;
  const std::string clip = folder.write("clip.bvh", small_bvh(5000)).string();
  const Stopped result =
      stopped(fmt::format("render '{}' -o '{}'", clip, (output / "film.mp4").string()), 0.3,
              "TERM $program; kill -INT");
  CHECK(result.exit_code == 130);
  CHECK(result.took_s < 1.0);
}
