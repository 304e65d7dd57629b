#include "tiny_pipeline.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>

namespace fs = std::filesystem;

namespace mcdbn::test {
namespace {

/// The synthesized clips of one subject, each in quotes.
std::string clips_of(const fs::path& folder, int subject) {
  std::string files;
  for (int clip = 1; clip <= 2; ++clip) {
    const fs::path file = folder / fmt::format("walk_s{:02}_{:02}.bvh", subject, clip);
    REQUIRE(fs::exists(file));
    files += fmt::format(" '{}'", file.string());
  }
  return files;
}

}  // namespace

const std::string kTinyGreedy =
    "--hidden 8 --mrbm-hidden 8 --phases 1 --gaussian-epochs 2 --binary-epochs 2 --mrbm-epochs 2";
const std::string kTiny =
    kTinyGreedy + " --fine-tuning-steps 3 --fine-tuning-windows 4 --augment-views 1";

CliResult synthesize(const fs::path& folder) {
  return run_cli(
      fmt::format("synthesize --action walk --clips 4 --subjects 2 --seconds 1.2 --seed 5 -o '{}'",
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
  training_messages_ = trained.standard_error;
}

bool have_device() {
  static const bool have = run_cli("devices").exit_code == 0;
  if (have) return true;
  const char* name = doctest::getContextOptions()->currentTest->m_name;
  if (std::getenv("MCDBN_ALLOW_NO_DEVICE") == nullptr)
    FAIL("no OpenCL device: nothing would be tested; MCDBN_ALLOW_NO_DEVICE=1 skips this test");
  MESSAGE("SKIPPED '", name, "': no OpenCL device here");
  return false;
}

}  // namespace mcdbn::test
