#include "tiny_pipeline.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace fs = std::filesystem;

namespace mcdbn::test {
namespace {

/// The synthesized clips of one subject, each in quotes.
std::string clips_of(const fs::path& folder, int subject) {
  std::string files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(fmt::format("_s{:02}_", subject)) !=
        std::string::npos)
      files += fmt::format(" '{}'", entry.path().string());
  }
  REQUIRE(!files.empty());
  return files;
}

}  // namespace

const std::string kTinyGreedy =
    "--hidden 8 --mrbm-hidden 8 --phases 1 --gaussian-epochs 2 --binary-epochs 2 --mrbm-epochs 2";
const std::string kTiny = kTinyGreedy + " --joint-steps 3 --joint-windows 4 --augment-views 2";

CliResult synthesize(const fs::path& folder) {
  return run_cli(
      fmt::format("synthesize --action walk --clips 4 --subjects 2 --seconds 3 --seed 5 -o '{}'",
                  folder.string()));
}

CliResult train(const std::string& clips, const fs::path& run, const std::string& options,
                const std::string& environment) {
  return run_cli(fmt::format("train {} -o '{}' {}", clips, run.string(), options), environment);
}

const TinyPipeline& TinyPipeline::instance() {
  static const TinyPipeline pipeline;
  return pipeline;
}

std::string TinyPipeline::training_clips() const {
  return clips_of(motion(), 1);
}

std::string TinyPipeline::test_clips() const {
  return clips_of(motion(), 2);
}

TinyPipeline::TinyPipeline() {
  REQUIRE(synthesize(motion()).exit_code == 0);
  const CliResult trained = train(training_clips(), folder_ / "run", kTiny);
  CAPTURE(trained.standard_error);
  REQUIRE(trained.exit_code == 0);
  REQUIRE(trained.standard_output.empty());
}

bool have_device() {
  static const bool have = run_cli("devices").exit_code == 0;
  if (!have) MESSAGE("SKIPPED: no OpenCL device here");
  return have;
}

}  // namespace mcdbn::test
