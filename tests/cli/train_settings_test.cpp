// Every setting of training on its way: from flags and files into the record, the model and the
// library's own training.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "all_settings_run.hpp"
#include "base/safetensors.hpp"
#include "base/text_file.hpp"
#include "library_calls.hpp"
#include "settings_table.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using mcdbn::TrainingConfig;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A setting in the nested record of a model file.
double number_at(const json& record, std::string name) {
  std::replace(name.begin(), name.end(), '.', '/');
  const json& value = record.at(json::json_pointer("/" + name));
  return value.is_boolean() ? static_cast<double>(value.get<bool>()) : value.get<double>();
}

void check_equal(const json& line, const char* name, const std::optional<double>& value) {
  CAPTURE(name);
  CHECK(line.contains(name) == value.has_value());
  if (value && line.contains(name)) CHECK(line.at(name).get<double>() == *value);
}

/// Every setting but those in `wanted` is as in `base`.
void check_settings(const std::map<std::string, double>& found, const TrainingConfig& base,
                    const std::map<std::string, double>& wanted) {
  CHECK(found.size() == setting_rows().size());
  for (const SettingRow& row : setting_rows()) {
    CAPTURE(row.name);
    const auto set = wanted.find(row.name);
    CHECK(found.at(row.name) == (set == wanted.end() ? row.read(base) : set->second));
  }
}

/// Every field of a line of metrics.jsonl but the speed.
void check_line(const json& line, const mcdbn::EpochReport& epoch) {
  CAPTURE(line.dump());
  CHECK(line.at("stage") == epoch.stage);
  CHECK(line.at("epoch") == epoch.epoch);
  CHECK(line.at("loss").get<double>() == epoch.loss);
  CHECK(line.at("windows_per_s").get<double>() > 0);
  check_equal(line, "held_out_loss", epoch.held_out_loss);
  const bool healthy = epoch.health.has_value();
  const mcdbn::LayerHealth health = epoch.health.value_or(mcdbn::LayerHealth{});
  const auto if_healthy = [&](double value) {
    return healthy ? std::optional(value) : std::nullopt;
  };
  check_equal(line, "hidden_activity", if_healthy(health.hidden_activity));
  check_equal(line, "saturation", if_healthy(health.saturation));
  check_equal(line, "weight_norm", if_healthy(health.weight_norm));
  check_equal(line, "weight_norm_A", health.weight_norm_A);
  check_equal(line, "weight_norm_B", health.weight_norm_B);
  check_equal(line, "free_run_error", health.free_run_error);
}

}  // namespace

TEST_CASE("every setting's name stands for the member that the table gives") {
  std::set<std::string> unknown;
  for (const SettingRow& row : setting_rows()) unknown.insert(row.name);
  const TrainingConfig defaults;
  TrainingConfig config;
  mcdbn::visit_settings(config, [&](const mcdbn::Setting& setting, auto& member) {
    const std::string& name = setting.name;
    CAPTURE(name);
    CHECK(setting.help.size() > 3);
    CHECK(unknown.erase(name) == 1);
    const SettingRow& row = setting_row(name);
    CHECK(row.read(defaults) != row.value);
    CHECK(row.read(config) == row.read(defaults));
    member = static_cast<std::decay_t<decltype(member)>>(row.value);
    CHECK(row.read(config) == row.value);
    TrainingConfig written;
    row.write(written, row.value);
    CHECK(row.read(written) == row.value);
  });
  for (const std::string& name : unknown) FAIL_CHECK(name << " is no setting");
  for (const SettingRow& row : setting_rows()) CHECK(row.read(config) == row.value);
}

TEST_CASE("the help gives each setting's unit, default, reason and range, by groups") {
  const std::string help = run_cli("train --help").standard_output;
  const auto shown = [&](const std::string& words) {
    return help.find(words) != std::string::npos;
  };
  CHECK(shown("\n  --hidden UNITS=768 "));
  CHECK(shown("Hidden units of every CRBM (at least 1 and at most 100000)"));
  CHECK(shown("\n  --gaussian-rate NUMBER=0.001"));
  CHECK(shown("\n  --camera-fov DEGREES=45.0"));
  CHECK(shown("Vertical field of view (above 0 and below"));
  CHECK(shown("where the skeleton has sides (default: on)"));
  CHECK(shown("Keep a leading calibration pose (default: off)"));
  CHECK(shown("A person (with"));
  CHECK(shown("k of CD-k:"));
  for (const char* group : {"Settings:", "Settings of gaussian:", "Settings of fine-tuning:",
                            "Settings of augment:", "Settings of camera:"})
    CHECK(shown(std::string("\n") + group + "\n"));
}

TEST_CASE("flags of every setting arrive in config.toml and in the model's record") {
  if (!have_device()) return;
  const AllSettingsRun& run = AllSettingsRun::instance();
  const TrainingConfig wanted = all_settings();
  const json record = load_model(usual_device(), run.run() / "model.safetensors").config;
  CHECK(run.recorded().size() == setting_rows().size());
  for (const SettingRow& row : setting_rows()) {
    CAPTURE(row.name);
    REQUIRE(run.recorded().count(row.name) == 1);
    CHECK(run.recorded().at(row.name) == row.read(wanted));
    CHECK(number_at(record, row.name) == row.read(wanted));
  }
}

TEST_CASE("the program trains what the library trains with these settings, and logs every epoch") {
  if (!have_device()) return;
  const fs::path run = AllSettingsRun::instance().run();
  const json record = load_model(usual_device(), run / "model.safetensors").config;
  const LibraryTraining library = train_by_library(AllSettingsRun::clips(), all_settings(), record);
  CHECK(mcdbn::read_text_file(run / "model.safetensors") == library.model_file);

  std::istringstream lines(mcdbn::read_text_file(run / "metrics.jsonl"));
  std::size_t count = 0;
  bool held_out = false;
  for (std::string line; std::getline(lines, line); ++count) {
    REQUIRE(count < library.epochs.size());
    check_line(json::parse(line), library.epochs[count]);
    held_out |= library.epochs[count].held_out_loss.has_value();
  }
  CHECK(count == library.epochs.size());
  CHECK(held_out);  // the settings hold one of two people out
}

TEST_CASE("a settings file sets what flags set") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const fs::path file = folder.write("all.toml", all_toml());
  REQUIRE(train(AllSettingsRun::quoted_clips(), folder / "run",
                fmt::format("--quiet --config '{}'", file.string()))
              .exit_code == 0);
  const fs::path flags = AllSettingsRun::instance().run();
  for (const char* name : {"config.toml", "model.safetensors"})
    CHECK(mcdbn::read_text_file(folder / "run" / name) == mcdbn::read_text_file(flags / name));
}

TEST_CASE("a flag overrides the file, the file overrides the preset") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const fs::path file = folder.write("some.toml",
                                     "seed = 12\nlook-ahead = 3\nkeep-first-frame = true\n"
                                     "[gaussian]\nrate = 0.3\nepochs = 2\n"
                                     "[augment]\nmirror = false\n");
  // Flags stand before and after the file.
  const auto found =
      settings_of_options(fmt::format("--seed 4 --preset paper --config '{}' --no-keep-first-frame "
                                      "--hidden 8 --mrbm-hidden 8 --gaussian-rate-B 0.25",
                                      file.string()));
  check_settings(found, TrainingConfig::paper(),
                 {{"seed", 4},
                  {"look-ahead", 3},
                  {"keep-first-frame", 0},
                  {"hidden", 8},
                  {"mrbm-hidden", 8},
                  {"gaussian.rate", 0.3},
                  {"gaussian.epochs", 2},
                  {"augment.mirror", 0},
                  {"gaussian.rate-B", 0.25}});
}

TEST_CASE("--preset and --stages set which stages there are and whose defaults hold") {
  if (!have_device()) return;
  using Wanted = std::map<std::string, double>;
  check_settings(settings_of_options(""), TrainingConfig{}, {});
  check_settings(settings_of_options("--preset default"), TrainingConfig{}, {});
  check_settings(settings_of_options("--preset paper"), TrainingConfig::paper(), {});
  check_settings(settings_of_options("--preset paper-stable"), TrainingConfig::paper_stable(), {});
  check_settings(settings_of_options("--preset generation --hidden 5"),
                 TrainingConfig::generation(), {{"hidden", 5}});
  check_settings(settings_of_options("--preset general"), TrainingConfig::general(), {});
  // A figure of each, from docs/formats.md, docs/generation.md and docs/corpus.md.
  CHECK(settings_of_options("--preset paper").at("mrbm.rate") == 0.1);
  CHECK(settings_of_options("--preset paper-stable").at("mrbm.rate") == 0.001);
  CHECK(settings_of_options("--preset generation").at("gaussian.history-noise") == 1);
  CHECK(settings_of_options("--preset general").at("fine-tuning.steps") == 30000);
  check_settings(settings_of_options("--stages greedy"), TrainingConfig::greedy(), {});
  check_settings(settings_of_options("--fine-tuning-steps 0 --hidden 6"), TrainingConfig::greedy(),
                 {{"hidden", 6}});
  check_settings(settings_of_options("--stages fine-tuning"), TrainingConfig{},
                 {{"fine-tuning.from-greedy", 0}});
  check_settings(settings_of_options("--no-fine-tuning-from-greedy"), TrainingConfig{},
                 {{"fine-tuning.from-greedy", 0}});
  const ScratchFolder folder;
  const auto by_file = [&](const char* settings) {
    const fs::path file = folder.write("s.toml", fmt::format("[fine-tuning]\n{}\n", settings));
    return fmt::format(" --config '{}'", file.string());
  };
  check_settings(
      settings_of_options("--stages both --fine-tuning-steps 7" + by_file("from-greedy = false")),
      TrainingConfig{}, {{"fine-tuning.steps", 7}});
  // A stage that is asked for runs, however many steps the preset or a file sets.
  const double steps = static_cast<double>(TrainingConfig{}.fine_tuning.steps);
  check_settings(settings_of_options("--preset paper --stages both"), TrainingConfig::paper(),
                 {{"fine-tuning.steps", steps}});
  check_settings(settings_of_options("--stages fine-tuning" + by_file("steps = 0")),
                 TrainingConfig{}, {{"fine-tuning.steps", steps}, {"fine-tuning.from-greedy", 0}});
  check_settings(settings_of_options("--stages greedy --layers 3" + by_file("steps = 5")),
                 TrainingConfig::greedy(), Wanted{{"layers", 3}});
}

TEST_CASE("an older model's settings are read as they are, out of today's ranges too") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  mcdbn::Safetensors file = mcdbn::read_safetensors(pipeline.model());
  json about = json::parse(file.metadata.at("mcdbn"));
  json& config = about.at("config");
  config["joint"] = config.at("fine-tuning");
  config.erase("fine-tuning");
  for (auto& [name, value] : config["joint"].items())
    if (name == "people-power") value = 2.0;
  config["joint"]["places"] = config["joint"].at("positions");
  config["joint"].erase("positions");
  file.metadata["mcdbn"] = about.dump();
  const fs::path older = pipeline.folder("older.safetensors");
  write_safetensors(older, file);
  const auto evaluated = [&](const fs::path& model) {
    const CliResult result =
        run_cli(fmt::format("evaluate --model '{}' --test {} --json --quiet --fit none",
                            model.string(), pipeline.test_clips()));
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    json summary = json::parse(result.standard_output);
    summary.erase("model_file");
    return summary;
  };
  CHECK(evaluated(older) == evaluated(pipeline.model()));
}

TEST_CASE("fine-tuning's settings are known by their former names too") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const fs::path file = folder.write("former.toml", "[joint]\nrate = 0.5\nplaces = 0.25\n");
  check_settings(settings_of_options(fmt::format("--joint-steps 7 --no-joint-from-greedy "
                                                 "--joint-places 0.75 --config '{}'",
                                                 file.string())),
                 TrainingConfig{},
                 {{"fine-tuning.steps", 7},
                  {"fine-tuning.from-greedy", 0},
                  {"fine-tuning.rate", 0.5},
                  {"fine-tuning.positions", 0.75}});
  check_settings(settings_of_options("--stages joint"), TrainingConfig{},
                 {{"fine-tuning.from-greedy", 0}});
  const std::string help = run_cli("train --help").standard_output;
  for (const char* former : {"--joint-steps", "--joint-from-greedy", "--joint-places"})
    CHECK(help.find(former) == std::string::npos);
  CHECK(help.find("{greedy,fine-tuning,both}") != std::string::npos);
  const std::string metrics =
      mcdbn::read_text_file(TinyPipeline::instance().folder("run") / "metrics.jsonl");
  CHECK(metrics.find("\"stage\":\"fine-tuning\"") != std::string::npos);
  CHECK(metrics.find("\"former_stage\":\"joint\"") != std::string::npos);
}
