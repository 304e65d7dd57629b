// A run folder: what is there stays until something whole takes its place, one training at a time,
// and one that was stopped goes on.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

const std::set<std::string> kWhole{"config.toml", "metrics.jsonl", "model.safetensors"};

/// Runs a shell script in which $cli is the program.
CliResult run_script(const ScratchFolder& folder, const std::string& script) {
  const fs::path file = folder.write("script.sh", fmt::format("cli='{}'\n{}", MCDBN_CLI, script));
  return run_program("/bin/bash", fmt::format("'{}'", file.string()));
}

/// Waits until a file holds something while a program runs.
std::string wait_for(const fs::path& file) {
  return fmt::format("while kill -0 $program 2>/dev/null && [ ! -s '{}' ]; do sleep 0.02; done\n",
                     file.string());
}

/// Long enough to be stopped in its greedy stages.
const std::string kLong =
    "--quiet --hidden 8 --mrbm-hidden 8 --phases 1 --layers 1 --stages greedy --mrbm-epochs 2 "
    "--gaussian-epochs ";

}  // namespace

TEST_CASE("a folder that holds a training is not taken for another without --force") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path run = pipeline.folder("taken");
  const auto train_there = [&](const std::string& more) {
    return train(pipeline.training_clips(), run, kTiny + " --quiet " + more);
  };
  REQUIRE(train_there("").exit_code == 0);
  CHECK(entries_of(run) == kWhole);
  const std::string model = mcdbn::read_text_file(run / "model.safetensors");
  const CliResult refused = train_there("--seed 3");
  CHECK(refused.exit_code == 2);
  CHECK(refused.standard_error ==
        fmt::format("mcdbn-cl: error: {}: holds a training already; --force trains anew in its "
                    "place, --resume goes on with one that was interrupted\n",
                    run.string()));
  CHECK(mcdbn::read_text_file(run / "model.safetensors") == model);
  CHECK(entries_of(run) == kWhole);

  const CliResult failed = train_there("--force --gaussian-rate 100");
  CHECK(failed.exit_code == 1);
  CHECK(mcdbn::read_text_file(run / "model.safetensors") == model);
  CHECK(mcdbn::read_text_file(run / "config.toml").find("rate = 1000000000") == std::string::npos);

  REQUIRE(train_there("--force --seed 3").exit_code == 0);
  CHECK(mcdbn::read_text_file(run / "model.safetensors") != model);
  CHECK(entries_of(run) == kWhole);
}

TEST_CASE("a training that is refused before it begins leaves the place free") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path bad = folder.write("bad.bvh", "HIERARCHY\n");
  const std::string clips = pipeline.training_clips();
  const std::string run = "new/run";
  const auto refused = [&](const std::string& data, const std::string& more, int code) {
    CAPTURE(more);
    const CliResult result = train(data, folder / run, kTiny + " --quiet " + more);
    CHECK(result.exit_code == code);
    CHECK(result.standard_error.find("--resume") == std::string::npos);
    CHECK(entries_of(folder / "") == std::set<std::string>{"bad.bvh"});
  };
  refused(clips, "--look-ahead 900", 2);                            // no clip is as long
  refused(clips, "--batch 1000000 --hidden 100000 --layers 9", 2);  // nor any memory as large
  refused("'" + bad.string() + "'", "", 3);
  CHECK(train(clips, folder / run, kTiny + " --quiet").exit_code == 0);
}

TEST_CASE("one training at a time: a second one is refused, and the owner is named") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run";
  const CliResult result = run_script(
      folder, fmt::format("\"$cli\" train {0} -o '{1}' {2} 1000000 & program=$!\n{3}"
                          "\"$cli\" train {0} -o '{1}' {2} 2 --force; echo \"train $?\"\n"
                          "\"$cli\" train --resume '{1}'; echo \"resume $?\"\n"
                          "kill -TERM $program; wait $program; echo \"first $?\"\n"
                          "echo \"process $program\"\n",
                          pipeline.training_clips(), run.string(), kLong,
                          wait_for(run / "unfinished/metrics.jsonl")));
  CAPTURE(result.standard_error);
  CHECK(result.standard_output.starts_with("train 1\nresume 1\nfirst 130\nprocess "));
  const std::string process = result.standard_output.substr(result.standard_output.rfind('p'));
  const std::string owner =
      fmt::format("{}: in use by {} on ", run.string(), process.substr(0, process.size() - 1));
  const auto first = result.standard_error.find(owner);
  REQUIRE(first != std::string::npos);
  CHECK(result.standard_error.find(owner, first + 1) != std::string::npos);
  CHECK(entries_of(run) == std::set<std::string>{"unfinished"});
}

TEST_CASE("a training that was stopped goes on by --resume, with nothing else given") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run", whole = folder / "whole";
  const std::string settings = kLong + "300 --skeleton canonical";
  REQUIRE(train(pipeline.training_clips(), whole, settings).exit_code == 0);
  const CliResult stopped = run_script(
      folder, fmt::format("\"$cli\" train {} -o '{}' {} & program=$!\n{}kill -INT $program\n"
                          "wait $program\n",
                          pipeline.training_clips(), run.string(), settings,
                          wait_for(run / "unfinished/metrics.jsonl")));
  CHECK(stopped.exit_code == 130);
  CHECK(stopped.standard_error.ends_with(
      fmt::format("mcdbn-cl: error: interrupted; `mcdbn-cl train --resume {}` goes on from the "
                  "last checkpoint\n",
                  run.string())));
  CHECK(entries_of(run) == std::set<std::string>{"unfinished"});
  CHECK(entries_of(run / "unfinished").count("checkpoint.safetensors") == 1);

  const std::string resume = fmt::format("train --resume '{}' --quiet", run.string());
  const CliResult more = run_cli(resume + " --hidden 9");
  CHECK(more.exit_code == 2);
  CHECK(more.standard_error.find("leave --hidden out") != std::string::npos);
  REQUIRE(run_cli(resume).exit_code == 0);
  CHECK(entries_of(run) == kWhole);
  for (const char* name : {"model.safetensors", "config.toml"})
    CHECK(mcdbn::read_text_file(run / name) == mcdbn::read_text_file(whole / name));
  CHECK(count_lines(mcdbn::read_text_file(run / "metrics.jsonl")) ==
        count_lines(mcdbn::read_text_file(whole / "metrics.jsonl")));
  CHECK(run_cli(resume).exit_code == 0);  // it is done
  CHECK(run_cli("train --resume '" + (folder / "nothing").string() + "'").exit_code == 3);
}

TEST_CASE("--resume wants the clips that the training was begun with") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path run = folder / "run", clip = folder / "clip.bvh";
  fs::copy_file(pipeline.motion() / "walk_s01_01.bvh", clip);
  const CliResult stopped =
      run_script(folder, fmt::format("\"$cli\" train '{}' -o '{}' {} 1000000 & program=$!\n{}"
                                     "kill -TERM $program\nwait $program\n",
                                     clip.string(), run.string(), kLong,
                                     wait_for(run / "unfinished/metrics.jsonl")));
  REQUIRE(stopped.exit_code == 130);
  fs::copy_file(pipeline.motion() / "walk_s02_01.bvh", clip, fs::copy_options::overwrite_existing);
  const CliResult other = run_cli(fmt::format("train --resume '{}'", run.string()));
  CHECK(other.exit_code == 3);
  CHECK(other.standard_error.find("the clips are not those") != std::string::npos);
  fs::remove(clip);
  CHECK(run_cli(fmt::format("train --resume '{}'", run.string())).exit_code == 3);
}

TEST_CASE("names that are no text are found before training, and shown by info all the same") {
  if (!have_device()) return;
  const ScratchFolder folder;
  std::string text = small_bvh(60);
  const auto joint = text.find("Chest");
  const fs::path odd = folder.write("odd.bvh", text.replace(joint, 5, "Ch\xFFst"));
  const fs::path fine = folder.write("fi\xFFne.bvh", small_bvh(60));
  for (const fs::path& clip : {odd, fine}) {
    const CliResult result =
        run_cli(fmt::format("train '{}' -o '{}'", clip.string(), (folder / "run").string()));
    CHECK(result.exit_code == 3);
    CHECK(result.standard_error.find("is not UTF-8 text") != std::string::npos);
    CHECK(result.standard_error.find("windows/s") == std::string::npos);
  }
  const CliResult info = run_cli(fmt::format("info --json '{}'", odd.string()));
  REQUIRE(info.exit_code == 0);
  CHECK(nlohmann::json::parse(info.standard_output).at("joints").at(1) == "Ch\xEF\xBF\xBDst");
  CHECK(run_cli(fmt::format("info '{}'", odd.string())).exit_code == 0);
}
