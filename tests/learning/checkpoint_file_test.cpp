// A checkpoint's file: what was written comes back, what is damaged is refused with file and field.
#include "learning/checkpoint_file.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

CheckpointContent example() {
  CheckpointContent content;
  content.finished_stages["track.0"] = {{{"best_loss", 0.5}}, {{"W", {{2, 1}, {1, 2}}}}};
  content.running_stage = "pose.0";
  content.done_minibatches = 12;
  content.running_state = {{{"optimizer.steps", 12}, {"fresh", true}}, {{"W", {{1, 2}, {3, -4}}}}};
  content.extra_state.numbers = {{"clips.low", 4294967295U}};
  return content;
}

/// What is read of the example with one thing in it changed.
class Damaged {
 public:
  Damaged() {
    write_checkpoint(path(), example());
    file_ = read_safetensors(path());
  }
  std::filesystem::path path() const { return folder_ / "checkpoint.safetensors"; }
  json about() const { return json::parse(file_.metadata.at("mcdbn-checkpoint")); }

  std::string complaint(const json& about) const {
    Safetensors file = file_;
    file.metadata["mcdbn-checkpoint"] = about.dump();
    return complaint(file);
  }
  std::string complaint(const Safetensors& file) const {
    write_safetensors(path(), file);
    try {
      read_checkpoint(path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  const Safetensors& whole() const { return file_; }

 private:
  ScratchFolder folder_;
  Safetensors file_;
};

}  // namespace

TEST_CASE("a checkpoint's file holds everything") {
  const ScratchFolder folder;
  const CheckpointContent wanted = example();
  write_checkpoint(folder / "c", wanted);
  const CheckpointContent got = read_checkpoint(folder / "c");
  CHECK(got.running_stage == "pose.0");
  for (const TrainingState::Content& part :
       {got.running_state, got.extra_state, got.finished_stages.at("track.0")})
    CHECK(part.file == (folder / "c").string());
  CHECK(got.done_minibatches == 12);
  CHECK(got.running_state.numbers == wanted.running_state.numbers);
  CHECK(got.running_state.matrices.at("W").shape == std::vector<std::size_t>{1, 2});
  CHECK(got.running_state.matrices.at("W").values == std::vector<float>{3, -4});
  CHECK(got.extra_state.numbers == wanted.extra_state.numbers);
  REQUIRE(got.finished_stages.size() == 1);
  CHECK(got.finished_stages.at("track.0").numbers == wanted.finished_stages.at("track.0").numbers);
  CHECK(got.finished_stages.at("track.0").matrices.at("W").values == std::vector<float>{1, 2});
}

TEST_CASE("a checkpoint's numbers are believed no more than a model's") {
  const Damaged file;
  CHECK(file.complaint(file.about()).empty());
  struct Case {
    const char* field;
    json value;
    const char* wanted;
  };
  for (const Case& one : std::vector<Case>{{"/format_version", 2, ": format_version: "},
                                           {"/done", -1, ": done: "},
                                           {"/done", 1e300, ": done: "},
                                           {"/done", "x", ": done: "},
                                           {"/stage", 3, ": stage: "},
                                           {"/over", 3, ": over: "},
                                           {"/over/track.0", {1}, ": over.track.0: "},
                                           {"/now/fresh", "yes", ": now.fresh: "},
                                           {"/now/fresh", nullptr, ": now.fresh: "},
                                           {"/now/optimizer.steps", {1}, ": now.optimizer.steps: "},
                                           {"/more", nullptr, ": more: "}}) {
    CAPTURE(one.field);
    json about = file.about();
    about[json::json_pointer(one.field)] = one.value;
    const std::string message = file.complaint(about);
    CHECK(message.starts_with(file.path().string() + one.wanted));
  }
  for (const char* field : {"format_version", "over", "stage", "done", "now", "more"}) {
    CAPTURE(field);
    json about = file.about();
    about.erase(field);
    CHECK(file.complaint(about).starts_with(file.path().string() + ": no key '" + field + "'"));
  }
  Safetensors odd = file.whole();
  odd.tensors.at("pose.0/W").values[0] = std::numeric_limits<float>::quiet_NaN();
  CHECK(file.complaint(odd).starts_with(file.path().string() + ": tensor 'pose.0/W' "));
  odd.metadata.clear();
  CHECK(file.complaint(odd) == file.path().string() + ": no checkpoint of mcdbn-cl");
}

TEST_CASE("a training takes no number of another kind for one of its own") {
  const auto restored = [](const json& stored, auto number) {
    TrainingState::Content content{{{"n", stored}}, {}};
    TrainingState state = TrainingState::restoring(content);
    state.number("n", number);
    return number;
  };
  CHECK(restored(5, std::size_t{0}) == 5);
  CHECK(restored(true, false));
  CHECK(restored(2, 0.5) == 2.0);
  CHECK(restored(2147483647, 0) == 2147483647);
  for (const json& odd : {json(-1), json(1e300), json(0.5), json(true), json("1"), json()}) {
    CAPTURE(odd.dump());
    CHECK_THROWS_AS(restored(odd, std::size_t{0}), InputError);
    CHECK_THROWS_AS(restored(odd, 0), InputError);
  }
  CHECK_THROWS_AS(restored(2147483648, 0), InputError);
  CHECK_THROWS_AS(restored(1, false), InputError);
  CHECK_THROWS_AS(restored(true, 0.5), InputError);
}
