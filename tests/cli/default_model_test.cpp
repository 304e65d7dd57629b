// The general model that comes with the program.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/safetensors.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "run_cli.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

const fs::path kProgram = MCDBN_CLI;

fs::path shipped() {
  return fs::path(MCDBN_SOURCE_DIR) / "cli" / "default_model.safetensors";
}

}  // namespace

TEST_CASE("the default model: small, whom to thank, and nothing of the machine it was made on") {
  CHECK(fs::file_size(shipped()) <= 10'000'000);
  const auto metadata = mcdbn::read_safetensors(shipped()).metadata;
  CHECK(metadata.at("acknowledgement").find("mocap.cs.cmu.edu") != std::string::npos);
  const auto about = nlohmann::json::parse(metadata.at("mcdbn"));
  CHECK(about.at("training_clips").size() > 50);
  for (const auto& clip : about.at("training_clips"))
    CHECK(clip.at("path").get<std::string>().find('/') == std::string::npos);
}

TEST_CASE("the default model: info, regenerate and evaluate take it and report it") {
  const CliResult info = run_cli("info --json");
  REQUIRE(info.exit_code == 0);
  CHECK(nlohmann::json::parse(info.standard_output).contains("acknowledgement"));

  const ScratchFolder folder;
  const std::string motion = (folder / "motion").string(), track = (folder / "track.csv").string();
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1.5 -o '{}'", motion))
              .exit_code == 0);
  const std::string clip = fs::directory_iterator(motion)->path().string();
  REQUIRE(run_cli(fmt::format("project '{}' --like openpose -o '{}'", clip, track)).exit_code == 0);
  const auto regenerate = [&](const std::string& model, const std::string& name) {
    const CliResult result = run_cli(fmt::format("regenerate --input '{}' {} -o '{}' --fit none",
                                                 track, model, (folder / name).string()));
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    CHECK((result.standard_error.find("no --model") != std::string::npos) == model.empty());
    return mcdbn::read_text_file(folder / name);
  };
  CHECK(regenerate("", "a.bvh") ==
        regenerate(fmt::format("--model '{}'", shipped().string()), "b.bvh"));
  // It was trained when all the humanoid's joints had the order Z X Y.
  const mcdbn::Skeleton answer = mcdbn::read_bvh(folder / "a.bvh").skeleton;
  REQUIRE(mcdbn::is_humanoid(answer));
  for (std::size_t j = 0; j < answer.joints.size(); ++j)
    CHECK(answer.joints[j].channels == mcdbn::canonical_humanoid().joints[j].channels);
  const CliResult evaluated =
      run_cli(fmt::format("evaluate --test '{}' --baselines none --fit none", clip));
  CAPTURE(evaluated.standard_error);
  CHECK(evaluated.exit_code == 0);
  // Its training clips are elsewhere.
  const auto usual = [&](const std::string& more) {
    return run_cli(fmt::format("evaluate --test '{}' --fit none {}", clip, more));
  };
  const CliResult alone = usual("");
  CAPTURE(alone.standard_error);
  CHECK(alone.exit_code == 0);
  CHECK(alone.standard_error.find("no simpler methods") != std::string::npos);
  CHECK(usual("--baselines usual").exit_code == 3);
}

TEST_CASE("the default model: notices name what the command has, and a program without one too") {
  const auto notice = [](const std::string& call, const std::string& words) {
    const CliResult result = run_cli(call);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    CHECK(result.standard_error.find("info: " + words + ": the general one, ") !=
          std::string::npos);
  };
  notice("info", "no file");
  notice("train --from default --print-settings", "--from default");
  const ScratchFolder folder;
  fs::create_directory(folder / "bin");
  fs::copy(kProgram, folder / "bin");
  const auto check_without = [&](const std::string& call, const std::string& words) {
    const CliResult alone = run_program(folder / "bin" / kProgram.filename(), call);
    CAPTURE(alone.standard_error);
    CHECK(alone.exit_code == 2);
    CHECK(alone.standard_error.find("error: " + words + ": this program comes without") !=
          std::string::npos);
  };
  check_without("info", "no file");
  check_without("train --from default --print-settings", "--from default");
}
