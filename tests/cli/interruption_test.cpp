// Ctrl-C ends the program, whatever it does, before it has computed for another second on every
// processor, and leaves nothing behind: its own work is counted, as others share the clock.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// A second of all processors.
const double kMost_s = std::max(1U, std::thread::hardware_concurrency());

struct Stopped {
  int exit_code = -1;
  double computed_s = 0;  ///< by all its threads, from the signal on
};

/// Starts a command that would take long, signals it after a while.
Stopped stopped(const std::string& arguments, double after_s, const std::string& signals = "INT") {
  const ScratchFolder folder;
  // A shell that is no terminal's starts programs deaf to Ctrl-C until they listen by themselves.
  const fs::path script =
      folder.write("stop.py", fmt::format(R"py(
import os, shlex, signal, subprocess, sys, time
process = subprocess.Popen(['{0}'] + shlex.split("""{1}"""), stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
def words(name):
    with open(f"/proc/{{process.pid}}/{{name}}") as file:
        return file.read()
def blocked():
    line = next(line for line in words("status").splitlines() if line.startswith("SigBlk:"))
    return int(line.split()[1], 16)
def computed_s():
    user, system = words("stat").rsplit(")", 1)[1].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")
while not blocked() & 1 << (signal.SIGINT - 1):
    time.sleep(0.02)
time.sleep({2})
before_s = computed_s()
for name in '{3}'.split():
    process.send_signal(getattr(signal, "SIG" + name))
used = os.wait4(process.pid, 0)
print(used[2].ru_utime + used[2].ru_stime - before_s)
sys.exit(os.waitstatus_to_exitcode(used[1]) % 256)
)py",
                                          MCDBN_CLI, arguments, after_s, signals));
  const CliResult result = run_program("/usr/bin/python3", fmt::format("'{}'", script.string()));
  CAPTURE(result.standard_error);
  REQUIRE(!result.standard_output.empty());
  return {result.exit_code, std::strtod(result.standard_output.c_str(), nullptr)};
}

void check_stopped(const std::string& arguments, double after_s) {
  CAPTURE(arguments);
  const Stopped result = stopped(arguments, after_s);
  CHECK(result.exit_code == 130);
  CHECK(result.computed_s < kMost_s);
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
  // The first of each two runs has the kernels built: the driver cannot be stopped within one,
  // however long a busy machine takes for it. One epoch of the second training takes minutes.
  const auto training = [&](const std::string& run, int batches) {
    return fmt::format(
        "train {} -o '{}' --stages greedy --hidden 256 --gaussian-epochs 1 "
        "--binary-epochs 1 --mrbm-epochs 1 --least-batches {} --batch 50",
        pipeline.training_clips(), (output / run).string(), batches);
  };
  REQUIRE(run_cli(training("built", 1)).exit_code == 0);
  check_stopped(training("run", 4000), 1.5);
  const auto generation = [&](const std::string& motion, int frames) {
    return fmt::format("generate --model '{}' --seed-clip '{}' -o '{}' --frames {}",
                       pipeline.model().string(), (pipeline.motion() / "walk_s01_01.bvh").string(),
                       (output / motion).string(), frames);
  };
  REQUIRE(run_cli(generation("built.bvh", 50)).exit_code == 0);
  check_stopped(generation("out.bvh", 1000000), 1.5);
  CHECK(!fs::exists(output / "out.bvh"));
}

TEST_CASE("a second signal ends the program at once, with the same exit code") {
  const ScratchFolder folder, output;
  const std::string clip = folder.write("clip.bvh", small_bvh(5000)).string();
  const Stopped result = stopped(
      fmt::format("render '{}' -o '{}'", clip, (output / "film.mp4").string()), 0.3, "TERM INT");
  CHECK(result.exit_code == 130);
  CHECK(result.computed_s < kMost_s);
}
