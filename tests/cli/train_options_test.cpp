// Every option of train, and what it changes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>

#include "all_settings_run.hpp"
#include "base/text_file.hpp"
#include "option_table.hpp"
#include "settings_table.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// Shorter still than kTiny.
const std::string kQuick =
    kTinyGreedy + " --stages greedy --layers 1 --order 2 --least-batches 1 --batch 36";

std::string with_dashes(std::string name) {
  std::replace(name.begin(), name.end(), '.', '-');
  return name;
}

/// Whether a switch is on where every second one is: those with even numbers, or the others.
bool is_on(std::size_t number, bool even) {
  return (number % 2 == 0) == even;
}

/// The options that a switch stands beside; those of which they are the same stand together.
std::string beside(const SettingRow& row) {
  const std::string name = row.name;
  if (name == "mrbm.persistent" || name == "mrbm.sample-visible") return "--mrbm-joint-likelihood";
  return apart(name).value_or("--layers 2 --gaussian-final-rate 0.5 --binary-final-rate 0.5");
}

/// What is set where all switches that stand beside these options are given, `--mirror` or
/// `--no-mirror`, and a file sets the opposite.
std::map<std::string, double> switched(bool even, const std::string& options) {
  const ScratchFolder folder;
  std::string opposite, flags;
  std::size_t number = 0;
  for (const SettingRow& row : setting_rows()) {
    if (!row.is_switch || beside(row) != options) continue;
    const bool on = is_on(number++, even);
    opposite += fmt::format("{} = {}\n", row.name, !on);
    flags += (on ? " --" : " --no-") + with_dashes(row.name);
  }
  const fs::path file = folder.write("opposite.toml", opposite);
  return settings_of_options(fmt::format("--config '{}' {}{}", file.string(), options, flags));
}

/// Its flag stands in the run with all flags, or apart; its value in the record, not the default.
void check_setting(const SettingRow& row) {
  const auto options = apart(row.name);
  const auto recorded = options ? settings_of_options(flag_of(row) + " " + *options)
                                : AllSettingsRun::instance().recorded();
  REQUIRE(recorded.count(row.name) == 1);
  CHECK(recorded.at(row.name) == row.value);
  CHECK(row.read(mcdbn::TrainingConfig{}) != row.value);
}

/// No layer above the lowest has Gaussian units.
void check_binary_deviation(const SettingRow& row) {
  const CliResult result = run_cli("train --print-settings --layers 2 " + flag_of(row));
  CHECK(result.exit_code == 2);
  CHECK(result.standard_error.find("is of Gaussian units without history") != std::string::npos);
}

std::vector<OptionRow> setting_option_rows() {
  std::vector<OptionRow> rows;
  std::map<std::string, std::size_t> numbers;  // of the switches beside the same options
  for (const SettingRow& row : setting_rows()) {
    const std::string name = row.name, options = beside(row);
    if (!row.is_switch) {
      const bool is_refused = name == "binary.deviation-rate";
      rows.push_back({"--" + with_dashes(name), [&row, is_refused] {
                        is_refused ? check_binary_deviation(row) : check_setting(row);
                      }});
      continue;
    }
    const std::size_t number = numbers[options]++;
    for (const bool even : {false, true}) {
      const bool on = is_on(number, even);
      rows.push_back({(on ? "--" : "--no-") + with_dashes(name),
                      [=] { CHECK(switched(even, options).at(name) == (on ? 1.0 : 0.0)); }});
    }
  }
  return rows;
}

}  // namespace

TEST_CASE("train: every option changes what its help describes") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run";
  const auto model = [&] { return mcdbn::read_text_file(run / "model.safetensors"); };
  const auto trained = [&](const std::string& clips, const std::string& options) {
    const CliResult result = train(clips, run, kQuick + " --force " + options);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return result;
  };
  const CliResult plain_result = trained(pipeline.training_clips(), "");
  const std::string plain = model();

  std::vector<OptionRow> rows = setting_option_rows();
  const std::string call =
      fmt::format("train {} -o '{}' {} --force", pipeline.training_clips(), run.string(), kQuick);
  for (const OptionRow& row : device_rows(call, model)) rows.push_back(row);
  rows.push_back({"data", [&] {
                    trained(pipeline.test_clips(), "");
                    CHECK(model() != plain);
                    CHECK(train("absent.bvh", run, "").exit_code == 3);
                  }});
  rows.push_back({"--output", [&] {
                    const fs::path other = folder / "a/b/run";
                    CHECK(train(pipeline.training_clips(), other, kQuick).exit_code == 0);
                    for (const char* file : {"model.safetensors", "metrics.jsonl", "config.toml"})
                      CHECK(fs::file_size(other / file) > 100);
                  }});
  rows.push_back({"--quiet", [&] {
                    CHECK(plain_result.standard_error.find("mrbm epoch 2/2") != std::string::npos);
                    CHECK(plain_result.standard_error.find("info: ") != std::string::npos);
                    CHECK(trained(pipeline.training_clips(), "--quiet").standard_error.empty());
                    CHECK(model() == plain);
                  }});
  rows.push_back({"--config", [&] {
                    const fs::path file = folder.write("c.toml", "seed = 3\n");
                    trained(pipeline.training_clips(), fmt::format("--config '{}'", file.string()));
                    const std::string by_file = model();
                    CHECK(by_file != plain);
                    trained(pipeline.training_clips(), "--seed 3");
                    CHECK(model() == by_file);
                    CHECK(train("x.bvh", run, "--config absent.toml").exit_code == 2);
                  }});
  // What these do has test cases of its own, and scripts_test.py.
  rows.push_back({"--preset", [&] {
                    CHECK(train("x.bvh", run, "--preset other").exit_code == 2);
                    CHECK(train(pipeline.training_clips(), run,
                                kTiny + " --preset general --order 2 --least-batches 1 "
                                        "--fine-tuning-view-uses 0 --force")
                              .exit_code == 0);
                    CHECK(model().find("JOINT left_shoulder") !=
                          std::string::npos);  // the humanoid
                  }});
  rows.push_back(
      {"--stages", [&] { CHECK(train("x.bvh", run, "--stages other").exit_code == 2); }});
  rows.push_back({"--skeleton", [&] {
                    CHECK(train("x.bvh", run, "--skeleton other").exit_code == 2);
                    trained(pipeline.training_clips(), "--skeleton own");
                    CHECK(model() == plain);
                    const CliResult canonical =
                        trained(pipeline.training_clips(), "--skeleton canonical");
                    CHECK(canonical.standard_error.find("brought onto the canonical humanoid") !=
                          std::string::npos);
                    CHECK(model().find("JOINT left_shoulder") != std::string::npos);
                    CHECK(plain.find("JOINT left_shoulder") == std::string::npos);
                  }});
  rows.push_back(
      {"--joint-map", [&] {
         const fs::path map = folder.write("map.toml", "head = \"Neck\"\n");
         const std::string mapped = fmt::format("--joint-map '{}'", map.string());
         trained(pipeline.training_clips(), mapped);
         CHECK(model().find("JOINT left_shoulder") != std::string::npos);  // the humanoid
         CHECK(train(pipeline.training_clips(), run, kQuick + " --force --skeleton own " + mapped)
                   .exit_code == 2);
         folder.write("map.toml", "left_knee = \"LeftFoot\"\n");
         const CliResult lame =
             train(pipeline.training_clips(), run, kQuick + " --force " + mapped);
         CHECK(lame.exit_code == 3);
         CHECK(lame.standard_error.find("left_ankle") != std::string::npos);
         folder.write("map.toml", "left_knee = \"LeftLeggg\"\n");
         CHECK(trained(pipeline.training_clips(), mapped)
                   .standard_error.find("left_knee is 'LeftLeggg', and no clip has") !=
               std::string::npos);
         folder.write("map.toml", "left_knee = 3\n");
         CHECK(train("x.bvh", run, mapped).exit_code == 3);
       }});
  rows.push_back(
      {"--from", [&] {
         const fs::path start = folder.write("start.safetensors", plain);
         const auto from = [&](const std::string& what, const std::string& options) {
           return train(pipeline.test_clips(), folder / "from",
                        fmt::format("--force --fine-tuning-steps 2 --fine-tuning-windows "
                                    "4 --augment-views 1 --from {} {}",
                                    what, options));
         };
         const CliResult result = from(fmt::format("'{}'", start.string()), "");
         CAPTURE(result.standard_error);
         CHECK(result.exit_code == 0);
         const std::string info =
             run_cli(fmt::format("info '{}'", (folder / "from/model.safetensors").string()))
                 .standard_output;
         CHECK(info.find("start.safetensors") != std::string::npos);
         CHECK(recorded_settings(folder / "from").at("fine-tuning.rate") ==
               mcdbn::FineTuningSettings::kRateFromModel);
         const std::string printed =
             "train --print-settings --fine-tuning-steps 2 "
             "--fine-tuning-windows 4 --augment-views 1 --from ";
         CHECK(run_cli(fmt::format("{} '{}'", printed, start.string())).standard_output ==
               mcdbn::read_text_file(folder / "from/config.toml"));
         CHECK(run_cli(printed + "absent").exit_code == 3);
         CHECK(run_cli(printed + "default --hidden 99").exit_code == 2);
         CHECK(from("absent", "").exit_code == 3);
         const CliResult wider = from(fmt::format("'{}'", start.string()), "--hidden 99");
         CHECK(wider.exit_code == 2);
         CHECK(wider.standard_error.find("--hidden is 99, but") != std::string::npos);
         CHECK(from("default", "--hidden 99").standard_error.find("start from") !=
               std::string::npos);
       }});
  rows.push_back(
      {"--tracks", [&] {
         CHECK(train("x.bvh", run, "--tracks other").exit_code == 2);
         const auto share = [&](const std::string& options) {
           const fs::path made = folder / "tracks";
           REQUIRE(train(pipeline.training_clips(), made, kTiny + options).exit_code == 0);
           const std::string text = mcdbn::read_text_file(made / "config.toml");
           fs::remove_all(made);
           const auto at = text.find("detector = ");
           return text.substr(at, text.find('\n', at) - at);
         };
         CHECK(share(" --tracks exact") == "detector = 0.0");
         CHECK(share(" --tracks detector").starts_with("detector = 0.8"));
         const auto printed = [](const std::string& options) {
           return settings_of_options(options).at("augment.detector");
         };
         const fs::path file = folder.write("d.toml", "[augment]\ndetector = 0.5\n");
         const std::string by_file = fmt::format("--config '{}' ", file.string());
         CHECK(printed("--preset general") == 0.8);
         CHECK(printed("--preset general --tracks exact") == 0);
         CHECK(printed(by_file + "--tracks exact") == 0);
         CHECK(printed(by_file + "--tracks detector") == 0.5);
         for (const char* tracks : {"", "--tracks exact ", "--tracks detector "})
           for (const double given : {0.0, 0.25})
             CHECK(printed(fmt::format("{}{}--augment-detector {}", by_file, tracks, given)) ==
                   given);
       }});
  rows.push_back({"--force", [&] {
                    CHECK(train(pipeline.training_clips(), run, kQuick).exit_code == 2);
                    trained(pipeline.training_clips(), "");  // which gives it
                  }});
  rows.push_back({"--resume", [&] {  // of a training that is done; run_folder_test.cpp has others
                    const std::string resume = fmt::format("train --resume '{}'", run.string());
                    const CliResult result = run_cli(resume);
                    CHECK(result.exit_code == 0);
                    CHECK(result.standard_error.find("training is already complete") !=
                          std::string::npos);
                    CHECK(run_cli(resume + " --seed 1").exit_code == 2);
                  }});
  rows.push_back({"--print-settings", [&] {  // as --config reads them
                    const CliResult printed = run_cli("train --print-settings " + kQuick);
                    CHECK(printed.exit_code == 0);
                    const fs::path file = folder.write("all.toml", printed.standard_output);
                    REQUIRE(train(pipeline.training_clips(), run,
                                  fmt::format("--force --config '{}'", file.string()))
                                .exit_code == 0);
                    CHECK(model() == plain);
                    CHECK(mcdbn::read_text_file(run / "config.toml") == printed.standard_output);
                  }});
  rows.push_back({"--checkpoint-minutes", [&] {
                    CHECK(train("x.bvh", run, "--checkpoint-minutes -1").exit_code == 2);
                    trained(pipeline.training_clips(), "--checkpoint-minutes 0");
                    CHECK(model() == plain);
                  }});
  rows.push_back({"--sweep", [&] {
                    const CliResult result =
                        train(pipeline.training_clips(), folder / "sweep", "--sweep absent.toml");
                    CHECK(result.exit_code == 2);
                    CHECK(result.standard_error.find("absent.toml") != std::string::npos);
                  }});
  check_options("train", rows);
}
