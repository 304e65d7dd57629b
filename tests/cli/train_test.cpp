#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/capture_bound.hpp"
#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::set<std::string> stages_of(const fs::path& run) {
  std::set<std::string> stages;
  std::istringstream lines(mcdbn::read_text_file(run / "metrics.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const json metrics = json::parse(line);
    CHECK(metrics.at("loss").is_number());
    stages.insert(metrics.at("stage"));
  }
  return stages;
}

}  // namespace

TEST_CASE("train writes a run folder") {
  if (!have_device()) return;
  const fs::path run = TinyPipeline::instance().folder("run");
  CHECK(fs::exists(run / "model.safetensors"));
  CHECK(fs::exists(run / "config.toml"));
  CHECK(stages_of(run) == std::set<std::string>{"pose.0", "track.0", "mrbm", "fine-tuning"});
}

TEST_CASE("train reports its progress: in the end no time is left") {
  if (!have_device()) return;
  const std::string messages = TinyPipeline::instance().training_messages();
  CAPTURE(messages);
  const auto last = messages.find("100 %  fine-tuning epoch 3/3  loss ");
  REQUIRE(last != std::string::npos);
  CHECK(messages.substr(0, messages.find('\n', last)).ends_with(" windows/s  0 s left"));
  CHECK(messages.find("\nlearning how sure its answers are\n", last) != messages.npos);
}

TEST_CASE("train --stages leaves stages out") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const auto stages = [&](const std::string& options, const std::string& size) {
    const fs::path run = pipeline.folder("stages");
    const std::string all = size + " --quiet --force " + options;
    REQUIRE(train(pipeline.training_clips(), run, all).exit_code == 0);
    return stages_of(run);
  };
  const std::set<std::string> greedy{"pose.0", "pose.1", "track.0", "track.1", "mrbm"};
  const std::string two_layers = kTinyGreedy + " --binary-epochs 2";
  CHECK(stages("--stages greedy", two_layers) == greedy);
  CHECK(stages("--fine-tuning-steps 0", two_layers) == greedy);
  CHECK(stages("--stages both", kTiny) ==
        std::set<std::string>{"pose.0", "track.0", "mrbm", "fine-tuning"});
  CHECK(stages("--stages fine-tuning", "--hidden 8 --mrbm-hidden 8" + kTinyFineTuning) ==
        std::set<std::string>{"fine-tuning"});
  std::set<std::string> all = greedy;
  all.insert("fine-tuning");
  CHECK(stages("--stages both --layers 2 --binary-epochs 2", kTiny) == all);
}

TEST_CASE("train: what is of fine-tuning's views is refused where nothing is fine-tuned") {
  const ScratchFolder folder;
  const fs::path run = folder / "run";
  folder.write("clip.bvh", small_bvh(60));
  const std::string clip = fmt::format("'{}'", (folder / "clip.bvh").string());
  const auto refusal = [&](const std::string& options, int exit_code = 2) {
    const CliResult result = train(clip, run, kTinyGreedy + " --quiet " + options);
    CHECK(result.exit_code == exit_code);
    CHECK(!fs::exists(run));
    return result.standard_error;
  };
  const std::string why =
      " is of the views that fine-tuning learns from, and nothing is fine-tuned; leave it out\n";
  for (const char* stages : {"--stages greedy", "--fine-tuning-steps 0", "--preset generation"}) {
    CAPTURE(stages);
    const std::string without = stages;
    CHECK(refusal(without + " --tracks detector") == "mcdbn-cl: error: --tracks detector" + why);
    CHECK(refusal(without + " --augment-views 3") == "mcdbn-cl: error: --augment-views" + why);
    CHECK(refusal(without + " --no-augment-mirror") == "mcdbn-cl: error: --augment-mirror" + why);
  }
  for (const char* stages : {"--stages greedy", "--fine-tuning-steps 0"})
    CHECK(refusal(std::string("--preset general ") + stages) ==
          "mcdbn-cl: error: --preset general fine-tunes: leave out what turns that off (--stages "
          "greedy, --fine-tuning-steps 0), or choose another preset\n");
  // A sweep of which one configuration is fine-tuned takes them; --force it never takes.
  const auto sweep = [&](const char* steps) {
    const fs::path file =
        folder.write("sweep.toml", fmt::format("test = ['{}']\n[grid]\nfine-tuning.steps = {}\n",
                                               (folder / "clip.bvh").string(), steps));
    return fmt::format("--augment-views 3 --sweep '{}'", file.string());
  };
  CHECK(refusal(sweep("[0]")) == "mcdbn-cl: error: --augment-views" + why);
  CHECK(refusal(sweep("[0, 3]") + " --platform no-such-name", 4).find("no-such-name") !=
        std::string::npos);
  CHECK(refusal(sweep("[0, 3]") + " --force").find("--force does not apply") != std::string::npos);
}

TEST_CASE(
    "train: flags of stages and layers that there are not are refused, settings of files not") {
  const auto printed = [](const std::string& options) {
    return run_cli("train --print-settings " + options);
  };
  const auto check_refused = [&](const std::string& options, const std::string& flag,
                                 const char* why) {
    CAPTURE(options);
    const CliResult result = printed(options);
    CHECK(result.exit_code == 2);
    CHECK(result.standard_error ==
          fmt::format("mcdbn-cl: error: {} {}; leave it out\n", flag, why));
  };
  const char* const not_tuned = "is of fine-tuning, and nothing is fine-tuned";
  const char* const not_greedy = "is of the greedy stages, which are left out";
  const char* const one_layer = "is of the layers above the lowest, and there is one layer";
  check_refused("--stages greedy --fine-tuning-hold-out-among 2", "--fine-tuning-hold-out-among",
                not_tuned);
  check_refused("--preset generation --fine-tuning-windows 7", "--fine-tuning-windows", not_tuned);
  check_refused("--stages greedy --joint-places 1", "--joint-places", not_tuned);
  check_refused("--stages fine-tuning --gaussian-rate 0.1", "--gaussian-rate", not_greedy);
  check_refused("--stages fine-tuning --mrbm-epochs 9", "--mrbm-epochs", not_greedy);
  check_refused("--no-fine-tuning-from-greedy --people-power 1", "--people-power", not_greedy);
  check_refused("--binary-epochs 44", "--binary-epochs", one_layer);
  check_refused("--preset generation --binary-rate 0.1", "--binary-rate", one_layer);
  check_refused("--gaussian-fast-rate 0.1", "--gaussian-fast-rate",
                "is of persistent chains, and --gaussian-persistent is off");
  check_refused("--gaussian-cosine", "--gaussian-cosine",
                "is of rates that fall, and --gaussian-final-rate is 1");
  check_refused("--order 0 --gaussian-history-noise 1", "--gaussian-history-noise",
                "is of layers with history, and there is none");
  check_refused("--gaussian-deviation-rate 0.5", "--gaussian-deviation-rate",
                "is of Gaussian units without history, and there are none");
  check_refused("--stages greedy --mrbm-persistent", "--mrbm-persistent",
                "is of the joint likelihood's chains, and --mrbm-joint-likelihood is off");
  check_refused("--mrbm-joint-likelihood --mrbm-mean-field-steps 4", "--mrbm-mean-field-steps",
                "is of multi-prediction, and --mrbm-joint-likelihood is on");
  for (const char* flag : {"--regeneration-sampled", "--regeneration-gibbs-steps 7",
                           "--regeneration-mrbm-gibbs-steps 9"})
    check_refused(flag, std::string(flag).substr(0, std::string(flag).find(' ')),
                  "is of networks that are not fine-tuned: fine-tuning finds out itself how to "
                  "draw");

  const ScratchFolder folder;
  const fs::path file =
      folder.write("all.toml",
                   "[fine-tuning]\nwindows = 7\n[binary]\nrate = 0.1\n[gaussian]\nfast-rate = 0.1\n"
                   "cosine = true\n[mrbm]\npersistent = true\n[regeneration]\nsampled = true\n");
  for (const char* options :
       {"--stages greedy --layers 1 --config", "--stages fine-tuning --config"})
    CHECK(printed(fmt::format("{} '{}'", options, file.string())).exit_code == 0);
  for (const char* options :
       {"--layers 2 --binary-rate 0.1", "--stages greedy --binary-rate 0.1",
        "--gaussian-fast-rate 0.1 --gaussian-persistent",
        "--gaussian-cosine --gaussian-final-rate 0.5", "--preset generation --gaussian-cosine",
        "--order 0 --gaussian-deviation-rate 0.5", "--preset paper --regeneration-gibbs-steps 7",
        // The greedy stages' network infers by them, however it was learnt.
        "--stages greedy --mrbm-joint-likelihood --mrbm-mean-field-steps 4"}) {
    CAPTURE(options);
    CHECK(printed(options).exit_code == 0);
  }
}

TEST_CASE("train: --stages and flags that contradict it are refused, a file's settings not") {
  const auto printed = [](const std::string& options) {
    return run_cli("train --print-settings " + options);
  };
  for (const auto& [stages, flag] : std::initializer_list<std::pair<const char*, const char*>>{
           {"greedy", "--fine-tuning-steps 100"},
           {"greedy", "--joint-steps 100"},
           {"fine-tuning", "--fine-tuning-steps 0"},
           {"both", "--fine-tuning-steps 0"},
           {"both", "--no-fine-tuning-from-greedy"},
           {"fine-tuning", "--fine-tuning-from-greedy"}}) {
    CAPTURE_BOUND(flag);
    const CliResult result = printed(fmt::format("--stages {} {}", stages, flag));
    CHECK(result.exit_code == 2);
    CHECK(result.standard_error ==
          fmt::format("mcdbn-cl: error: --stages {} and {} contradict each other; leave one out\n",
                      stages, flag));
  }
  for (const char* options :
       {"--stages greedy --fine-tuning-steps 0", "--stages both --fine-tuning-steps 7",
        "--stages both --fine-tuning-from-greedy",
        "--stages fine-tuning --no-fine-tuning-from-greedy --fine-tuning-steps 7"}) {
    CAPTURE(options);
    CHECK(printed(options).exit_code == 0);
  }
  const ScratchFolder folder;
  const fs::path file =
      folder.write("stages.toml", "[fine-tuning]\nsteps = 7\nfrom-greedy = false\n");
  CHECK(printed(fmt::format("--stages greedy --config '{}'", file.string())).exit_code == 0);
}

TEST_CASE(
    "train: the printed settings hold the skeleton and the joint map, as --config reads them") {
  const ScratchFolder folder;
  const std::string map = folder.write("map.toml", "head = \"Neck\"\n").string();
  const auto printed = [](const std::string& options) {
    const CliResult result = run_cli("train --print-settings " + options);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return result.standard_output;
  };
  const auto again = [&](const std::string& text, const std::string& options = "") {
    const fs::path file = folder.write("all.toml", text);
    return printed(fmt::format("--config '{}' {}", file.string(), options));
  };
  const std::string plain = printed(""), canonical = printed("--skeleton canonical"),
                    mapped = printed(fmt::format("--joint-map '{}'", map));
  CHECK(canonical != plain);
  CHECK(mapped != plain);
  for (const std::string& text : {plain, canonical, mapped, printed("--preset general")})
    CHECK(again(text) == text);
  // Flags have the last word.
  CHECK(again(canonical, "--skeleton own") == printed("--skeleton own"));
  const std::string other = folder.write("other.toml", "left_knee = \"Knee\"\n").string();
  CHECK(again(mapped, fmt::format("--joint-map '{}'", other)) ==
        printed(fmt::format("--joint-map '{}'", other)));
}

TEST_CASE("the same seed trains the same model, from the recorded config too") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string model = mcdbn::read_text_file(pipeline.model());
  const fs::path config = pipeline.folder("run") / "config.toml";

  REQUIRE(train(pipeline.training_clips(), pipeline.folder("again"),
                fmt::format("--quiet --config '{}'", config.string()))
              .exit_code == 0);
  CHECK(mcdbn::read_text_file(pipeline.folder("again") / "model.safetensors") == model);
  REQUIRE(train(pipeline.training_clips(), pipeline.folder("other"), kTiny + " --quiet --seed 2")
              .exit_code == 0);
  CHECK(mcdbn::read_text_file(pipeline.folder("other") / "model.safetensors") != model);
}

TEST_CASE("a setting that is on is switched off by --no-NAME") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  REQUIRE(train(pipeline.training_clips(), pipeline.folder("unmirrored"),
                kTiny + " --quiet --no-augment-mirror")
              .exit_code == 0);
  const auto recorded = [&](const char* run) {
    return mcdbn::read_text_file(pipeline.folder(run) / "config.toml");
  };
  CHECK(recorded("run").find("mirror = true") != std::string::npos);
  CHECK(recorded("unmirrored").find("mirror = false") != std::string::npos);
}

TEST_CASE("Python's safetensors opens a model file") {
  if (!have_device()) return;
  const fs::path python = MCDBN_PYTHON;
  if (!fs::exists(python)) {
    MESSAGE("SKIPPED Python's safetensors: scripts/install_dependencies --test installs it");
    return;
  }
  const std::string script = fmt::format(
      "from safetensors.numpy import load_file\n"
      "import numpy\n"
      "tensors = load_file('{}')\n"
      "assert tensors and all(t.dtype == numpy.float32 and numpy.isfinite(t).all()\n"
      "                       for t in tensors.values())\n"
      "print(sum(t.size for t in tensors.values()))\n",
      TinyPipeline::instance().model().string());
  const ScratchFolder folder;
  const fs::path file = folder.write("open_model.py", script);
  const CliResult result = run_program(python, fmt::format("'{}'", file.string()));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(std::stol(result.standard_output) > 0);
}

TEST_CASE("the paper's own settings trip the divergence guard, which names what to lower") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path run = pipeline.folder("paper");
  const CliResult result = train(pipeline.training_clips(), run, "--preset paper --quiet");
  CHECK(result.exit_code == 1);
  CHECK(result.standard_error.find("; lower --gaussian-rate (now 0.1), --gaussian-rate-A (0.1)") !=
        std::string::npos);
  CHECK(!fs::exists(run / "model.safetensors"));
}

TEST_CASE("train --sweep: exit code 1 where every configuration failed, 0 where one did not") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const std::string test_clip = "'" + (pipeline.motion() / "walk_s02_01.bvh").string() + "'";
  const auto swept = [&](const char* rates) {
    const fs::path sweep = folder.write(
        "sweep.toml", fmt::format("test = [{}]\n[grid]\ngaussian.rate = {}\n", test_clip, rates));
    return train(pipeline.training_clips(), folder / "sweep",
                 fmt::format("{} --quiet --sweep '{}'", kTiny, sweep.string()));
  };
  const fs::path log = folder / "sweep/sweep.jsonl";
  const CliResult failed = swept("[50.0, 60.0]");
  CAPTURE(failed.standard_error);
  CHECK(failed.exit_code == 1);
  CHECK(failed.standard_error.ends_with(fmt::format(
      "error: {}: every configuration failed, for the reason in its line\n", log.string())));
  CHECK(failed.standard_output.find("gaussian.rate=60.0") != std::string::npos);
  CHECK(count_lines(mcdbn::read_text_file(log)) == 2);
  const CliResult some = swept("[50.0, 0.001]");
  CAPTURE(some.standard_error);
  CHECK(some.exit_code == 0);
  CHECK(count_lines(mcdbn::read_text_file(log)) == 3);
}

TEST_CASE("an unknown setting is exit code 2 and names its line") {
  const ScratchFolder folder;
  const fs::path config = folder.write("bad.toml", "order = 3\nhiden = 20\n");
  const CliResult result =
      train("absent.bvh", folder / "run", fmt::format("--config '{}'", config.string()));
  CHECK(result.exit_code == 2);
  CHECK(result.standard_error.find(config.string() + ":2: ") != std::string::npos);
  CHECK(!fs::exists(folder / "run"));
}

TEST_CASE("a platform or device that is not there is exit code 4 with the list") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const fs::path run = pipeline.folder("nowhere");
  const std::string name = json::parse(run_cli("devices --json").standard_output)
                               .at("devices")
                               .at(0)
                               .at("name")
                               .get<std::string>();
  for (const CliResult& result :
       {train(pipeline.training_clips(), run, "--platform no-such-platform"),
        train(pipeline.training_clips(), run, "", "MCDBN_DEVICE=no-such-device")}) {
    CHECK(result.exit_code == 4);
    CHECK(result.standard_error.find(name) != std::string::npos);
  }
  CHECK(!fs::exists(run));
}
