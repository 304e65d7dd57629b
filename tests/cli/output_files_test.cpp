// Files are replaced whole: an old one stays as it is until the new one is complete.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <set>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.insert(fs::relative(entry.path(), folder).string());
  return names;
}

/// Writes to a file in place would show through another link to it.
class KeptFile {
 public:
  KeptFile(const fs::path& file, const fs::path& link) : file_(file), link_(link) {
    fs::create_hard_link(file, link);
    text_ = mcdbn::read_text_file(file);
  }
  void check_replaced() const {
    CAPTURE(file_.string());
    CHECK(mcdbn::read_text_file(link_) == text_);
    CHECK(fs::hard_link_count(file_) == 1);
    CHECK(mcdbn::read_text_file(file_) != text_);
  }

 private:
  fs::path file_, link_;
  std::string text_;
};

/// Runs `first`, keeps a link to each output, runs `second`: every output is another file then.
void check_replaces(const ScratchFolder& folder, const std::vector<std::string>& outputs,
                    const std::string& first, const std::string& second) {
  const CliResult made = run_cli(first);
  CAPTURE(made.standard_error);
  REQUIRE(made.exit_code == 0);
  const ScratchFolder links;
  std::vector<KeptFile> kept;
  for (const std::string& output : outputs)
    kept.emplace_back(folder / output, links / std::to_string(kept.size()));
  const auto names = names_in(folder / ".");
  REQUIRE(run_cli(second).exit_code == 0);
  for (const KeptFile& file : kept) file.check_replaced();
  CHECK(names_in(folder / ".") == names);  // no temporary file is left
}

/// No file may grow above 512 bytes: as on a full disk.
constexpr const char* kFullDisk = "ulimit -f 1; trap '' XFSZ;";

/// The old file stays, the new one is refused, nothing else is left.
void check_keeps_old(const ScratchFolder& folder, const std::string& output,
                     const std::string& command, const char* environment) {
  CAPTURE(command);
  const std::string before = mcdbn::read_text_file(folder / output);
  REQUIRE(before.size() > 1100);
  const auto names = names_in(folder / ".");
  const CliResult result = run_cli(command, environment);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  CHECK(mcdbn::read_text_file(folder / output) == before);
  CHECK(names_in(folder / ".") == names);
}

std::string in(const ScratchFolder& folder, const std::string& name) {
  return fmt::format("'{}'", (folder / name).string());
}

}  // namespace

TEST_CASE("commands without a device replace their files whole") {
  const ScratchFolder folder;
  const ScratchFolder input;
  const std::string clip = fmt::format("'{}'", input.write("clip.bvh", small_bvh(80)).string());
  const std::string project = fmt::format("project {} -o {} --write-camera {}", clip,
                                          in(folder, "t.csv"), in(folder, "c.yaml"));
  check_replaces(folder, {"t.csv", "c.yaml"}, project, project + " --camera-azimuth 70");
  check_keeps_old(folder, "t.csv", fmt::format("project {} -o {}", clip, in(folder, "t.csv")),
                  kFullDisk);
  const std::string synthesize =
      fmt::format("synthesize --action clap --clips 2 --seconds 0.5 -o {}", in(folder, "clips"));
  check_replaces(folder, {"clips/clap_s01_01.bvh", "clips/clap_s02_01.bvh"}, synthesize,
                 synthesize + " --seed 4");
  check_keeps_old(folder, "clips/clap_s01_01.bvh", synthesize, kFullDisk);
  for (const char* name : {"r.png", "r.mp4"}) {
    const std::string render =
        fmt::format("render {} -o {} --image-size 96 96", clip, in(folder, name));
    check_replaces(folder, {name}, render, render + " --camera-azimuth -80");
  }
  check_keeps_old(folder, "r.png", fmt::format("render {} -o {}", clip, in(folder, "r.png")),
                  kFullDisk);
}

TEST_CASE("train, regenerate and evaluate replace their files whole") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const ScratchFolder input;
  const std::string clip = (pipeline.motion() / "walk_s02_01.bvh").string();
  const std::string track = (input / "t.csv").string();
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}'", clip, track)).exit_code == 0);
  const std::string regenerate =
      fmt::format("regenerate --model '{}' --input '{}' -o {} --fit none",
                  pipeline.model().string(), track, in(folder, "out.bvh"));
  check_replaces(folder, {"out.bvh"}, regenerate, regenerate + " --temperature 1");

  const std::string evaluate =
      fmt::format("evaluate --model '{}' --test '{}' --report {} --quiet --fit none",
                  pipeline.model().string(), clip, in(folder, "report"));
  check_replaces(folder,
                 {"report/summary.json", "report/report.html", "report/methods.csv",
                  "report/clips.csv", "report/table_3.csv"},
                 evaluate, evaluate + " --temperature 1");

  const std::string train =
      fmt::format("train {} -o {} {} --quiet", pipeline.training_clips(), in(folder, "run"), kTiny);
  check_replaces(folder, {"run/model.safetensors", "run/config.toml"}, train,
                 train + " --seed 2 --force");
}

TEST_CASE("a training that fails leaves the model of before whole") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  fs::create_directories(folder / "run");
  folder.write("run/model.safetensors", "of before");
  const CliResult result = train(pipeline.training_clips(), folder / "run",
                                 kTiny + " --quiet --force --gaussian-rate 100");
  CHECK(result.exit_code == 1);
  CHECK(count_lines(result.standard_error) == 1);
  CHECK(mcdbn::read_text_file(folder / "run/model.safetensors") == "of before");
  CHECK(names_in(folder / "run") == std::set<std::string>{"model.safetensors"});
}
