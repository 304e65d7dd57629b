#include "tiny_pipeline.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/text_file.hpp"

namespace fs = std::filesystem;

namespace mcdbn::test {
namespace {

constexpr const char* kMessages = "training_messages.txt";

/// Where CTest has it made once, for every file of cases; none where test_cli is run alone.
std::optional<fs::path> made_for_all() {
  const char* folder = std::getenv("MCDBN_TINY_PIPELINE");
  return folder == nullptr ? std::nullopt : std::optional<fs::path>(folder);
}

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

CliResult synthesize(const fs::path& folder) {
  return run_cli(
      fmt::format("synthesize --action walk --clips 4 --subjects 2 --seconds 1.2 --seed 5 -o '{}'",
                  folder.string()));
}

CliResult train(const std::string& clips, const fs::path& run, const std::string& options,
                const std::string& environment) {
  return run_cli(fmt::format("train {} -o '{}' {}", clips, run.string(), options), environment);
}

fs::path with_calibration_pose(const fs::path& clip, const fs::path& path) {
  std::string text = read_text_file(clip);
  const auto frames = text.find("Frames: ") + 8;
  const int count = std::stoi(text.substr(frames));
  text.replace(frames, std::to_string(count).size(), std::to_string(count + 1));
  const auto first = text.find('\n', text.find("Frame Time")) + 1;
  const std::string_view line =
      std::string_view(text).substr(first, text.find('\n', first) - first);
  std::string pose = "0";
  for (auto more = std::ranges::count(line, ' '); more > 0; --more) pose += " 0";
  text.insert(first, pose + "\n");
  fs::create_directories(path.parent_path());
  write_text_file(path, text);
  return path;
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
  const auto made = made_for_all();
  motion_ = made.value_or(folder("")) / "motion";
  if (made && fs::exists(*made / "run")) {
    fs::copy(*made / "run", folder("run"), fs::copy_options::recursive);
    training_messages_ = read_text_file(*made / kMessages);
    return;
  }
  REQUIRE(synthesize(motion()).exit_code == 0);
  const CliResult trained = train(training_clips(), folder("run"), kTiny);
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

TEST_CASE("the small job that the other files of cases take") {
  if (!mcdbn::test::have_device()) return;
  const auto made = mcdbn::test::made_for_all();
  if (made) fs::remove_all(*made);
  const auto& pipeline = mcdbn::test::TinyPipeline::instance();
  CHECK(fs::exists(pipeline.model()));
  if (!made) return;
  mcdbn::write_text_file(*made / mcdbn::test::kMessages, pipeline.training_messages());
  fs::copy(pipeline.folder("run"), *made / "run", fs::copy_options::recursive);
}
