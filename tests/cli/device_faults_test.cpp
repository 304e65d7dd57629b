// The command's messages about a device that fails, and what it keeps.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// The layer between the program and its driver: call, how many go well, code.
std::string failing(const std::string& fault) {
  return fmt::format("OPENCL_LAYERS='{}' MCDBN_LAYER_FAIL={}", MCDBN_OPENCL_LAYER, fault);
}

void check_device_error(const CliResult& result, const std::string& words) {
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 4);
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: "));
  CHECK(result.standard_error.find(words) != std::string::npos);
  CHECK(count_lines(result.standard_error) == 1);
}

}  // namespace

TEST_CASE(
    "a device that is lost in mid-training: exit code 4, and --resume ends with the same model") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run";
  const CliResult lost =
      train(pipeline.training_clips(), run, kTiny + " --quiet --checkpoint-minutes 0",
            failing("clEnqueueNDRangeKernel,60,-2,lost"));
  check_device_error(lost, "the device is lost");
  CHECK(lost.standard_error.find(fmt::format("`mcdbn-cl train --resume {}`", run.string())) !=
        std::string::npos);
  CHECK(!fs::exists(run / "model.safetensors"));
  CHECK(fs::exists(run / "unfinished/checkpoint.safetensors"));
  const CliResult resumed = run_cli(fmt::format("train --resume '{}' --quiet", run.string()));
  CAPTURE(resumed.standard_error);
  CHECK(resumed.exit_code == 0);
  CHECK(mcdbn::read_text_file(run / "model.safetensors") ==
        mcdbn::read_text_file(pipeline.model()));
}

TEST_CASE("no room on the device, kernels that are not built: exit code 4, nothing left behind") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run";
  const auto fails = [&](const std::string& fault) {
    return train(pipeline.training_clips(), run, kTiny + " --quiet", failing(fault));
  };
  check_device_error(fails("clCreateBuffer,3,-4"), "no room for ");
  check_device_error(fails("clBuildProgram,0,-11"), "building kernels with ");
  check_device_error(fails("clCreateContext,0,-2"), "opening the device: the device is lost");
  CHECK(!fs::exists(run));
}

TEST_CASE("a sweep goes on where the device has no room, and ends where it is lost") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path log = folder / "run/sweep.jsonl";
  const fs::path file =
      folder.write("sweep.toml", fmt::format("test = ['{}']\n[grid]\nseed = [1, 2]\n",
                                             (pipeline.motion() / "walk_s02_01.bvh").string()));
  const auto sweep = [&](const std::string& fault) {
    return train(pipeline.training_clips(), folder / "run",
                 fmt::format("{} --quiet --sweep '{}'", kTiny, file.string()), failing(fault));
  };
  check_device_error(sweep("clEnqueueNDRangeKernel,3,-2,lost"), "the device is lost");
  CHECK(!fs::exists(log));
  const CliResult refused = sweep("clCreateBuffer,3,-4");
  CAPTURE(refused.standard_error);
  CHECK(refused.exit_code == 1);
  CHECK(count_lines(mcdbn::read_text_file(log)) == 2);
}
