#include "mcdbn/motion_model/run_folder.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/joint_role.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "motion_model/example_model.hpp"

namespace run_folder_test {

using namespace mcdbn;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

TrainingConfig odd_config() {
  TrainingConfig config = TrainingConfig::greedy();
  config.seed = 77;
  config.fps = 29.97;
  config.gaussian.rate = 0.1 + 0.2;  // all digits come back
  config.skeleton = SkeletonUse::humanoid;
  config.joint_map = {{JointRole::left_knee, "Knie, links"}, {JointRole::head, "spam"}};
  return config;
}

const std::vector<ListedClip> kClips{{"/clips/b.bvh", "Anna", "walk"}, {"relative/a.bvh"}};

/// The program's current folder for one scope.
class CurrentFolder {
 public:
  explicit CurrentFolder(const fs::path& path) : before_(fs::current_path()) {
    fs::current_path(path);
  }
  ~CurrentFolder() { fs::current_path(before_); }
  CurrentFolder(const CurrentFolder&) = delete;
  CurrentFolder& operator=(const CurrentFolder&) = delete;

 private:
  fs::path before_;
};

}  // namespace

TEST_CASE("a run folder keeps what a training was begun with") {
  const test::ScratchFolder folder;
  const fs::path path = folder / "new/run";
  RunFolder::begin(path, odd_config(), kClips, false);
  CHECK(test::entries_of(path) == std::set<std::string>{"unfinished"});
  const RunFolder run = RunFolder::resume(path);
  CHECK(!run.is_complete());
  CHECK(settings_json(run.config()) == settings_json(odd_config()));
  CHECK(run.config().skeleton == SkeletonUse::humanoid);
  CHECK(run.config().joint_map == odd_config().joint_map);
  REQUIRE(run.clips().size() == 2);
  CHECK(run.clips()[0].file == "/clips/b.bvh");
  CHECK(run.clips()[0].person == "Anna");
  CHECK(run.clips()[0].action == "walk");
  CHECK(run.clips()[1].file == fs::absolute("relative/a.bvh"));
  CHECK_THROWS_AS(RunFolder::resume(path), Error);  // `run` has it
}

TEST_CASE("a run folder that holds a training is kept unless it is to be replaced") {
  for (const char* name :
       {"model.safetensors", "config.toml", "metrics.jsonl", "unfinished/run.json"}) {
    CAPTURE(name);
    const test::ScratchFolder folder;
    fs::create_directory(folder / "unfinished");
    folder.write(name, "of before");
    if (!std::string(name).starts_with("unfinished")) fs::remove(folder / "unfinished");
    CHECK_THROWS_AS(RunFolder::begin(folder / "", odd_config(), kClips, false), ConfigError);
    CHECK(read_text_file(folder / name) == "of before");
    CHECK_NOTHROW(RunFolder::begin(folder / "", odd_config(), kClips, true));
  }
  const test::ScratchFolder other;
  other.write("notes.txt", "a user's own");
  CHECK_NOTHROW(RunFolder::begin(other / "", odd_config(), kClips, false));
  CHECK(read_text_file(other / "notes.txt") == "a user's own");
}

TEST_CASE("a run folder that was left while its files were put in place is put right") {
  const test::ScratchFolder folder;
  const auto at = [&](const char* name) { return folder / name; };
  // As it is after config.toml was moved.
  fs::create_directory(folder / "unfinished");
  folder.write("config.toml", "new config");
  folder.write("metrics.jsonl", "old metrics");
  folder.write("unfinished/metrics.jsonl", "new metrics");
  folder.write("unfinished/model.safetensors", "new model");
  folder.write("unfinished/checkpoint.safetensors", "x");
  const RunFolder run = RunFolder::resume(folder / "");
  CHECK(run.is_complete());
  CHECK(read_text_file(at("config.toml")) == "new config");
  CHECK(read_text_file(at("metrics.jsonl")) == "new metrics");
  CHECK(read_text_file(at("model.safetensors")) == "new model");
  CHECK(!fs::exists(at("unfinished")));
}

TEST_CASE("one that was left when only the rest was to be removed is whole") {
  const test::ScratchFolder folder;
  fs::create_directory(folder / "unfinished");
  folder.write("model.safetensors", "new model");
  folder.write("unfinished/checkpoint.safetensors", "x");
  CHECK(RunFolder::resume(folder / "").is_complete());
  CHECK(read_text_file(folder / "model.safetensors") == "new model");
  CHECK(!fs::exists(folder / "unfinished"));
}

TEST_CASE("what a training that never began wrote is taken back, what was learnt is not") {
  const test::ScratchFolder folder;
  folder.write("model.safetensors", "of before");
  {
    RunFolder run = RunFolder::begin(folder / "", odd_config(), kClips, true);
    folder.write("unfinished/metrics.jsonl", "");  // opened, and no epoch came
    CHECK(run.discard_if_untrained());
  }
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"model.safetensors"});
  for (const char* learnt : {"metrics.jsonl", "checkpoint.safetensors",
                             "checkpoint.previous.safetensors", "model.safetensors"}) {
    CAPTURE(learnt);
    RunFolder run = RunFolder::begin(folder / "", odd_config(), kClips, true);
    folder.write(std::string("unfinished/") + learnt, "x");
    CHECK(!run.discard_if_untrained());
    CHECK(fs::exists(folder / "unfinished/run.json"));
  }
  RunFolder::begin(folder / "", odd_config(), kClips, true);
  CHECK(!RunFolder::resume(folder / "").discard_if_untrained());  // another command's
  CHECK(fs::exists(folder / "unfinished/run.json"));
}

TEST_CASE("what is no run folder is refused, and so is what is no text") {
  const test::ScratchFolder folder;
  CHECK_THROWS_AS(RunFolder::resume(folder / "absent"), InputError);
  CHECK_THROWS_AS(RunFolder::resume(folder / ""), InputError);
  fs::create_directory(folder / "unfinished");
  CHECK_THROWS_AS(RunFolder::resume(folder / ""), InputError);
  for (const char* text : {"", "{}", "[1]", R"({"settings": {}, "skeleton": 0, "clips": [{}]})"}) {
    folder.write("unfinished/run.json", text);
    CHECK_THROWS_AS(RunFolder::resume(folder / ""), InputError);
  }
  RunFolder::begin(folder / "begun", odd_config(), kClips, false);
  const json begun = json::parse(read_text_file(folder / "begun/unfinished/run.json"));
  struct Case {
    const char* field;
    json value;
    const char* wanted;
  };
  for (const Case& one : std::vector<Case>{{"/skeleton", 3, ": skeleton: "},
                                           {"/skeleton", -1, ": skeleton: "},
                                           {"/settings", "x", ": settings: "},
                                           {"/settings/hidden", 1000000000, ": settings: "},
                                           {"/settings/unknown", 1, ": settings: "},
                                           {"/joint_map/head", 7, ": joint_map.head: "},
                                           {"/clips", {{"a", 1}}, ": clips: "},
                                           {"/clips/1/person", 7, ": clips[1].person: "}}) {
    CAPTURE(one.field);
    json record = begun;
    record[json::json_pointer(one.field)] = one.value;
    folder.write("unfinished/run.json", record.dump());
    std::string message;
    try {
      RunFolder::resume(folder / "");
    } catch (const InputError& error) {
      message = error.what();
    }
    CHECK(message.starts_with((folder / "unfinished/run.json").string() + one.wanted));
  }
  for (const ListedClip& clip :
       {ListedClip{"/a\xFF.bvh"}, ListedClip{"/a.bvh", "\xFF"}, ListedClip{"/a.bvh", "", "\xFF"}})
    CHECK_THROWS_AS(RunFolder::begin(folder / "other", odd_config(), {clip}, false), InputError);
  CHECK(!fs::exists(folder / "other"));
}

TEST_CASE("a clip in a current folder whose name is no text is refused by its absolute name") {
  const test::ScratchFolder folder;
  const fs::path odd = folder / "folder \xFF";
  fs::create_directory(odd);
  const CurrentFolder current(odd);
  CHECK_THROWS_WITH_AS(RunFolder::begin(folder / "run", odd_config(), {ListedClip{"a.bvh"}}, false),
                       doctest::Contains("is not UTF-8 text"), InputError);
  CHECK(!fs::exists(folder / "run"));
}

TEST_CASE(
    "a model that cannot be written where it belongs is not lost, and its place is reported") {
  test::on_every_device([](Device& device) {
    const Model model = test::ExampleModel(false).on(device);
    const test::ScratchFolder folder, temporary;
    const auto failure = [&](const std::string& temporary_files) {
      const test::ScopedVariable variable("TMPDIR", temporary_files);
      RunFolder run = RunFolder::begin(folder / "run", odd_config(), kClips, true);
      // As on a full disk: no file of that name can be written.
      fs::create_directory(folder / "run/unfinished/model.safetensors");
      folder.write("run/unfinished/model.safetensors/x", "x");
      folder.write("run/unfinished/checkpoint.safetensors", "last");
      folder.write("run/unfinished/checkpoint.previous.safetensors", "room for more");
      try {
        run.complete(model);
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    const std::string message = failure((temporary / "").string()), lies = "the model lies in ";
    const auto at = message.find(lies);
    REQUIRE(at != std::string::npos);
    const auto begin = at + lies.size();
    const fs::path model_file = message.substr(begin, message.find(": make room", begin) - begin);
    CHECK(model_file.parent_path().parent_path() == (temporary / "").parent_path());
    CHECK(load_model(device, model_file).training_clips.size() == model.training_clips.size());
    CHECK(test::entries_of(folder / "run/unfinished") ==
          std::set<std::string>{"config.toml", "run.json", "model.safetensors",
                                "checkpoint.safetensors"});
    const std::string nowhere = failure((folder / "absent").string());
    CHECK(nowhere.find("go on from the last checkpoint: mcdbn-cl train --resume " +
                       (folder / "run").string()) != std::string::npos);
  });
}

}  // namespace run_folder_test
