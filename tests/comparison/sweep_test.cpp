#include "comparison/sweep.hpp"

#include <doctest/doctest.h>

#include <sstream>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "comparison/comparison_run.hpp"
#include "comparison/tiny_training.hpp"
#include "corpus/training_files.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/joint_role.hpp"

namespace sweep_test {

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::ordered_json;

namespace {

TrainingConfig tiny(const SweepConfiguration& varied) {
  TrainingConfig config = tiny_training();
  assign_settings(config, varied);
  return config;
}

GivenSetting given(const char* name, nlohmann::json value) {
  return {name, std::move(value), name};
}

std::vector<ordered_json> lines_of(const std::filesystem::path& file) {
  std::vector<ordered_json> lines;
  std::istringstream text(read_text_file(file));
  for (std::string line; std::getline(text, line);) lines.push_back(ordered_json::parse(line));
  return lines;
}

std::string error_in(const std::string& text) {
  const ScratchFolder folder;
  const auto file = folder.write("s.toml", text);
  try {
    read_sweep_file(file);
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    CHECK(message.starts_with(file.string() + ":"));
    return message.substr(file.string().size() + 1);
  }
  return "none";
}

std::vector<std::string> names_in(const std::string& text) {
  const ScratchFolder folder;
  std::vector<std::string> names;
  for (const auto& configuration :
       read_sweep_file(folder.write("s.toml", "test = ['t']\n" + text)).configurations)
    names.push_back(name_of(configuration));
  return names;
}

}  // namespace

TEST_CASE("sweep file: all combinations of a grid, and configurations as they are") {
  using Names = std::vector<std::string>;
  CHECK(names_in("[grid]\norder = [2, 3]\nhidden = [8, 9]\n") ==
        Names{"hidden=8,order=2", "hidden=8,order=3", "hidden=9,order=2", "hidden=9,order=3"});
  CHECK(names_in("[[configuration]]\ngaussian.rate = 0.5\n[[configuration]]\n"
                 "fine-tuning.from-greedy = false\nseed = [1, 2]\n") ==
        Names{"gaussian.rate=0.5", "fine-tuning.from-greedy=false,seed=1",
              "fine-tuning.from-greedy=false,seed=2"});
  CHECK(names_in("[[configuration]]\n") == Names{"base"});
}

TEST_CASE("sweep file: test clips are beside it, and each value keeps its place in the file") {
  const ScratchFolder folder;
  const auto file = folder.write("s.toml", "test = ['a.bvh', 'b/']\n[grid]\norder = [2,\n -3]\n");
  const SweepFile sweep = read_sweep_file(file);
  CHECK(sweep.test == std::vector{folder / "a.bvh", folder / "b/"});
  REQUIRE(sweep.configurations.size() == 2);
  CHECK(sweep.configurations[1][0].who == file.string() + ":3: order");
  CHECK(sweep.configurations[1][0].value == -3);
}

TEST_CASE("sweep file: more configurations than anybody means are refused before they are made") {
  std::string grid = "test = ['t']\n[grid]\n";
  for (const char* name : {"seed", "order", "hidden", "batch", "phases", "fps", "layers",
                           "look-ahead", "least-batches", "mrbm-hidden", "gaussian.rate"})
    grid += std::string(name) + " = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
  CHECK(error_in(grid) == " 100000000000 configurations; a sweep has 10000 at most");
  std::string half = "[[configuration]]\n";
  for (const char* name : {"seed", "order", "hidden"})
    half +=
        std::string(name) + " = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18]\n";
  CHECK(error_in("test = ['t']\n" + half + half) ==
        " 11664 configurations; a sweep has 10000 at most");
}

TEST_CASE("sweep file: what makes no sense is refused with its line") {
  CHECK(error_in("test = ['t']\n") == " nothing to try: give a [grid] or [[configuration]]");
  CHECK(error_in("[grid]\nseed = [1]\n") == " no 'test': name the clips to score on");
  CHECK(error_in("test = 't'\n").starts_with("1: 'test' is a list"));
  CHECK(error_in("test = [3]\n").starts_with("1: 'test' is a list"));
  CHECK(error_in("test = ['t']\ngird = 3\n").starts_with("2: 'gird' is none of"));
  CHECK(error_in("test = ['t']\n[grid]\nseed = []\n") == "3: 'seed' has no value to try");
  CHECK(error_in("test = ['t']\n[grid]\nseed = ['x']\n")
            .starts_with("3: a setting is a number or true or false"));
}

TEST_CASE(
    "sweep: a line for each configuration, failed ones too, none that was scored done twice") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    std::filesystem::remove_all(folder / "run");
    std::vector<bool> begun;
    const Sweep::Watch watch = [&](bool counts) {
      begun.push_back(counts);
      return EpochObserver();
    };
    const auto sweep = [&] {
      return Sweep(device, {files.files()[1]}, {files.files()[0]}, tiny, folder / "run");
    };
    const ordered_json scored = sweep().run({given("order", 3)}, watch);
    CAPTURE(scored.dump());
    CHECK(scored.at("name") == "order=3");
    CHECK(scored.at("status") == "ok");
    CHECK(scored.at("settings").at("order") == 3);
    CHECK(scored.at("clips") == 1);
    CHECK(scored.at("training_s").get<double>() > 0);
    CHECK(scored.at("mpjpe_mm").get<double>() > 0);
    CHECK(begun == std::vector<bool>{false, true});
    CHECK(std::filesystem::exists(folder / "run/order=3/model.safetensors"));

    const ordered_json diverged = sweep().run({given("gaussian.rate", 100)});
    CHECK(diverged.at("status") == "failed");
    CHECK(diverged.at("error").get<std::string>().find("`gaussian.rate`") != std::string::npos);
    const ordered_json refused = sweep().run({given("hidden", 0)});
    CHECK(refused.at("error") == "hidden must be at least 1 and at most 100000, not 0");
    CHECK(refused.at("settings") == ordered_json{{"hidden", 0}});

    begun.clear();
    const auto file = folder / "run/sweep.jsonl";
    const std::string text = read_text_file(file);
    write_text_file(file, text + "{\"name\":\"cut");
    CHECK(sweep().run({given("order", 3)}, watch) == scored);
    CHECK(sweep().run({given("hidden", 0)}, watch) == refused);
    CHECK(begun.empty());
    CHECK(lines_of(folder.write("whole.jsonl", text)) ==
          std::vector<ordered_json>{scored, diverged, refused});
  });
}

TEST_CASE("sweep: what is scored are the network's own answers, seen as it was trained") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    std::filesystem::remove_all(folder / "run");
    const SweepConfiguration varied{given("camera.azimuth", -50)};
    const ordered_json scored =
        Sweep(device, {files.files()[1]}, {files.files()[0]}, tiny, folder / "run").run(varied);
    CAPTURE(scored.dump());
    REQUIRE(scored.at("status") == "ok");
    const Model model =
        load_model(device, folder / ("run/" + name_of(varied)) / "model.safetensors");
    TestRunOptions options;
    options.camera.azimuth_deg = -50;
    options.fit.reset();
    options.baselines.clear();
    const ClipScore score = run_test(model, {files.files()[1]}, options).at(0).samples.at(0).score;
    CHECK(scored.at("pcc_flat").get<double>() == score.pcc_flat);
    CHECK(scored.at("pcc_channel").get<double>() == score.pcc_channel);
    CHECK(scored.at("mpjpe_mm").get<double>() == score.error.mpjpe_mm);
    CHECK(score.pcc_flat != score.pcc_channel);
  });
}

TEST_CASE("sweep: a configuration has a folder, though its name may be too long for one") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  // The longest name that file systems take, then two that begin alike.
  const SweepConfiguration longest(32, given("order", 3));
  REQUIRE(name_of(longest).size() == 255);
  std::vector<SweepConfiguration> longer(2, SweepConfiguration(40, given("order", 3)));
  longer[0].push_back(given("hidden", 7));
  longer[1].push_back(given("hidden", 8));
  on_every_device([&](Device& device) {
    std::filesystem::remove_all(folder / "run");
    int trainings = 0;
    const auto run = [&](const SweepConfiguration& configuration) {
      Sweep sweep(device, {files.files()[1]}, {files.files()[0]}, tiny, folder / "run");
      const ordered_json record = sweep.run(configuration, [&](bool counts) {
        trainings += counts ? 1 : 0;
        return EpochObserver();
      });
      CAPTURE(record.dump());
      REQUIRE(record.at("status") == "ok");
      CHECK(record.at("name") == name_of(configuration));
      const std::string own = record.at("folder");
      CHECK(own.size() <= 255);
      CHECK(std::filesystem::exists(folder / ("run/" + own) / "model.safetensors"));
      return own;
    };
    CHECK(run(longest) == name_of(longest));
    const std::string one = run(longer[0]), other = run(longer[1]);
    CHECK(one != other);
    CHECK(name_of(longer[0]).starts_with(one.substr(0, 150)));
    CHECK(trainings == 3);
    CHECK(run(longer[0]) == one);
    CHECK(run(longest) == name_of(longest));
    CHECK(trainings == 3);
    CHECK(lines_of(folder / "run/sweep.jsonl").size() == 3);
  });
}

TEST_CASE("sweep: what was scored with other clips or another skeleton is done anew in its place") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}, {.subject = 3}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    std::filesystem::remove_all(folder / "run");
    const auto log = folder / "run/sweep.jsonl";
    const auto put = [&](const char* name, std::size_t file) {
      return folder.write(name, read_text_file(files.files()[file]));
    };
    const auto training = put("training.bvh", 0), test = put("test.bvh", 1);
    TrainingConfig choices;
    std::string person;
    int trainings = 0;
    /// @return how many trainings it took
    const auto run = [&] {
      trainings = 0;
      const auto resolve = [&](const SweepConfiguration& varied) {
        TrainingConfig config = tiny(varied);
        config.skeleton = choices.skeleton;
        config.joint_map = choices.joint_map;
        return config;
      };
      Sweep sweep(device, {test}, {ListedClip(training, person)}, resolve, folder / "run");
      const ordered_json record = sweep.run({}, [&](bool counts) {
        if (counts) ++trainings;
        return EpochObserver();
      });
      CAPTURE(record.dump());
      CHECK(record.at("status") == "ok");
      REQUIRE(lines_of(log).size() == 1);
      CHECK(lines_of(log).front().at("fingerprint") == record.at("fingerprint"));
      return trainings;
    };
    CHECK(run() == 1);
    CHECK(run() == 0);
    put("test.bvh", 2);
    CHECK(run() == 1);
    put("training.bvh", 1);
    CHECK(run() == 1);
    person = "somebody";
    CHECK(run() == 1);
    choices.skeleton = SkeletonUse::humanoid;
    CHECK(run() == 1);
    choices.joint_map = {{JointRole::head, "Neck"}};
    CHECK(run() == 1);
    CHECK(run() == 0);
    // A line of an older program.
    ordered_json older = lines_of(log).front();
    older.erase("fingerprint");
    write_text_file(log, older.dump() + '\n');
    CHECK(run() == 1);
  });
}

TEST_CASE("sweep: what failed is tried again, and its line replaced") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    std::filesystem::remove_all(folder / "run");
    Sweep sweep(device, {files.files()[1]}, {files.files()[0]}, tiny, folder / "run");
    const Sweep::Watch fails = [](bool) -> EpochObserver {
      return [](const EpochReport&) { throw Error("no luck"); };
    };
    CHECK(sweep.run({}, fails).at("error") == "no luck");
    const ordered_json scored = sweep.run({});
    CHECK(scored.at("status") == "ok");
    CHECK(lines_of(folder / "run/sweep.jsonl") == std::vector<ordered_json>{scored});
  });
}

TEST_CASE(
    "sweep: work that the device refuses is a failure of its own, a device that is lost ends it") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    std::filesystem::remove_all(folder / "run");
    Sweep sweep(device, {files.files()[1]}, {files.files()[0]}, tiny, folder / "run");
    const auto fails = [](const DeviceError& error) -> Sweep::Watch {
      return [=](bool) -> EpochObserver { return [=](const EpochReport&) { throw error; }; };
    };
    const ordered_json refused =
        sweep.run({}, fails(DeviceError("no room", DeviceError::Kind::refused)));
    CHECK(refused.at("status") == "failed");
    CHECK(refused.at("error") == "no room");
    CHECK_THROWS_AS(sweep.run({given("order", 3)}, fails(DeviceError("lost"))), DeviceError);
    CHECK(lines_of(folder / "run/sweep.jsonl") == std::vector<ordered_json>{refused});
  });
}

TEST_CASE("sweep: an observer may stop it, and no line records a failed configuration") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    Sweep sweep(device, {files.files()[1]}, {files.files()[0]}, tiny, folder / "stopped");
    const Sweep::Watch watch = [](bool counts) -> EpochObserver {
      return [=](const EpochReport&) {
        if (counts) throw Interrupted("stop");
      };
    };
    CHECK_THROWS_AS(sweep.run({}, watch), Interrupted);
    CHECK(!std::filesystem::exists(folder / "stopped/sweep.jsonl"));
  });
}

}  // namespace sweep_test
