#include "all_settings_run.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "base/text_file.hpp"
#include "settings_table.hpp"
#include "tiny_pipeline.hpp"

namespace mcdbn::test {
namespace fs = std::filesystem;

const AllSettingsRun& AllSettingsRun::instance() {
  static const AllSettingsRun run;
  return run;
}

fs::path AllSettingsRun::run() const {
  return TinyPipeline::instance().folder("all_settings");
}

std::vector<fs::path> AllSettingsRun::clips() {
  const fs::path motion = TinyPipeline::instance().motion();
  return {motion / "walk_s01_01.bvh", motion / "walk_s01_02.bvh", motion / "walk_s02_01.bvh",
          motion / "walk_s02_02.bvh"};
}

std::string AllSettingsRun::quoted_clips() {
  std::string quoted;
  for (const fs::path& clip : clips()) quoted += fmt::format(" '{}'", clip.string());
  return quoted;
}

AllSettingsRun::AllSettingsRun() {
  const ScratchFolder folder;
  const fs::path file = folder.write("apart.toml", toml_of_those_apart());
  const CliResult result =
      train(quoted_clips(), run(), fmt::format("--config '{}'{}", file.string(), all_flags()));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  recorded_ = recorded_settings(run());
}

namespace {

std::map<std::string, double> settings_of_toml(const std::string& text) {
  std::map<std::string, double> settings;
  for (const auto& setting : settings_in(text))
    CHECK_MESSAGE(settings.emplace(setting).second, setting.first, " is recorded once");
  return settings;
}

}  // namespace

std::map<std::string, double> recorded_settings(const fs::path& run) {
  return settings_of_toml(read_text_file(run / "config.toml"));
}

std::map<std::string, double> settings_of_options(const std::string& options) {
  const CliResult result = run_cli("train --print-settings " + options);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_error.empty());
  return settings_of_toml(result.standard_output);
}

}  // namespace mcdbn::test
