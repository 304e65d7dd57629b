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
  for (const char* name : {"r.png", "r.mp4"})
    check_keeps_old(folder, name, fmt::format("render {} -o {}", clip, in(folder, name)),
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

TEST_CASE("a training for which the disk is too full from the start leaves nothing in its way") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const CliResult full = train(pipeline.training_clips(), folder / "run", kTiny, kFullDisk);
  CAPTURE(full.standard_error);
  CHECK(full.exit_code == 3);
  CHECK(entries_of(folder / "").empty());
  CHECK(train(pipeline.training_clips(), folder / "run", kTiny + " --quiet").exit_code == 0);
}

TEST_CASE(
    "a fitted machine that has no room where it belongs is kept elsewhere, and that is reported") {
  if (!have_device()) return;
  const ScratchFolder folder, temporary;
  std::string rows;
  for (int i = 0; i < 40; ++i) rows += fmt::format("{},{}\n", i % 3, i % 5);
  const fs::path data = folder.write("data.csv", rows);
  // The file's room goes to a folder while the machine is fitted.
  const fs::path
      out = folder / "rbm.safetensors",
      script = folder.write(
          "fit.sh",
          fmt::format(
              "TMPDIR='{0}' '{1}' fit '{2}' --machine gaussian-rbm --hidden 3 --quiet "
              "--gaussian-epochs 3000 -o '{3}' & program=$!\n"
              "until ls -A '{4}' | grep -q mcdbn || ! kill -0 $program; do sleep 0.01; done\n"
              "mkdir '{3}'\nwait $program\n",
              (temporary / "").string(), MCDBN_CLI, data.string(), out.string(),
              (folder / "").string()));
  const CliResult result = run_program("/bin/bash", fmt::format("'{}'", script.string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  const std::string lies = "the machine lies in ";
  const auto at = result.standard_error.find(lies);
  REQUIRE(at != std::string::npos);
  const auto begin = at + lies.size();
  const std::string kept =
      result.standard_error.substr(begin, result.standard_error.find(": make room", begin) - begin);
  CHECK(kept.starts_with((temporary / "").string()));
  CHECK(run_cli(fmt::format("info '{}'", kept)).exit_code == 0);
  CHECK(entries_of(folder / "") == std::set<std::string>{"data.csv", "fit.sh", "rbm.safetensors"});
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
