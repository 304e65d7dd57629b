// Every option of generate, and what it changes: compared with what the library makes of the same.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <optional>

#include "base/text_file.hpp"
#include "library_calls.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/motion_model/clip_generation.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

namespace generate_options_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

struct Call {
  fs::path model;
  std::vector<fs::path> seed_clips;
  std::optional<std::size_t> frames = {}, samples = {}, gibbs_steps = {};
  std::optional<double> temperature = {}, seed_every = {};
  std::optional<std::uint64_t> seed = {};

  std::string arguments(const fs::path& output) const {
    std::string text =
        fmt::format("generate --model '{}' -o '{}' --seed-clip", model.string(), output.string());
    for (const fs::path& clip : seed_clips) text += fmt::format(" '{}'", clip.string());
    const auto add = [&](const char* flag, const auto& value) {
      if (value) text += fmt::format(" {} {}", flag, *value);
    };
    add("--frames", frames);
    add("--samples", samples);
    add("--gibbs-steps", gibbs_steps);
    add("--temperature", temperature);
    add("--seed", seed);
    add("--seed-every", seed_every);
    return text;
  }
};

/// The defaults are written out here once more, as the help gives them.
std::vector<std::string> by_library(const Call& call) {
  const mcdbn::Model model = load_model(usual_device(), call.model);
  mcdbn::GenerationOptions options;
  options.frames = call.frames.value_or(300);
  options.samples = call.samples.value_or(1);
  options.gibbs_steps = call.gibbs_steps.value_or(30);
  options.temperature = call.temperature.value_or(2.0);
  options.seed = call.seed.value_or(1);
  std::vector<std::string> texts;
  std::vector<mcdbn::SeedClip> seeds;
  for (const fs::path& clip : call.seed_clips)
    seeds.push_back({clip.string(), mcdbn::load_clip(clip), call.seed_every.value_or(0)});
  for (const mcdbn::Motion& motion : generate_clips(model, seeds, options))
    texts.push_back(bvh_text(motion));
  return texts;
}

/// out.bvh, or out_01.bvh and so on.
std::vector<std::string> by_program(const Call& call) {
  const ScratchFolder folder;
  const CliResult result = run_cli(call.arguments(folder / "out.bvh"));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_output.empty());
  const auto samples = std::distance(fs::directory_iterator(folder / "."), {});
  std::vector<std::string> texts;
  for (int i = 1; i <= samples; ++i) {
    const fs::path file = folder / (samples == 1 ? "out.bvh" : fmt::format("out_{:02}.bvh", i));
    REQUIRE(fs::exists(file));
    texts.push_back(mcdbn::read_text_file(file));
  }
  return texts;
}

/// Equal to the library's answer, and another answer than without the change.
void check_same(const Call& call, const std::vector<std::string>& before) {
  const auto texts = by_program(call);
  CHECK(texts == by_library(call));
  CHECK(texts != before);
}

/// Of the person who was trained on: a stranger drives so small a network's units to 0 and 1.
fs::path seed_clip(int clip) {
  return TinyPipeline::instance().motion() / fmt::format("walk_s01_{:02}.bvh", clip);
}

}  // namespace

TEST_CASE("generate: every option changes what its help describes") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const Call plain{.model = pipeline.model(),
                   .seed_clips = {seed_clip(1)},
                   .frames = 60,
                   .samples = 2,
                   .gibbs_steps = 4,
                   .temperature = 1.0,
                   .seed = 7};
  const auto before = by_program(plain);
  CHECK(before == by_library(plain));
  CHECK(before[0] != before[1]);
  const auto row = [&](const char* option, const std::function<void(Call&)>& change) {
    return OptionRow{option, [=] {
                       Call changed = plain;
                       change(changed);
                       check_same(changed, before);
                     }};
  };
  std::vector<OptionRow> rows = {
      row("--seed", [](Call& c) { c.seed = 9; }),
      row("--temperature", [](Call& c) { c.temperature = 0.3; }),
      row("--samples", [](Call& c) { c.samples = 3; }),
      row("--frames", [](Call& c) { c.frames = 31; }),
      row("--seed-every", [](Call& c) { c.seed_every = 0.5; }),
      row("--gibbs-steps", [](Call& c) { c.gibbs_steps = 0; }),
      row("--seed-clip",
          [](Call& c) {
            c.seed_clips = {seed_clip(2), seed_clip(1)};
          }),
      row("--model", [&](Call& c) {
        REQUIRE(train(pipeline.test_clips(), folder / "run", kTiny).exit_code == 0);
        c.model = folder / "run/model.safetensors";
      })};
  const fs::path output = folder / "named.bvh";
  Call one = plain;
  one.samples = 1;
  const auto text = [=] { return mcdbn::read_text_file(output); };
  for (const OptionRow& each : device_rows(one.arguments(output), text)) rows.push_back(each);
  rows.push_back({"--output", [&] { CHECK(text() == by_library(one).at(0)); }});
  rows.push_back({"--quiet", [&] {
                    const std::string call = one.arguments(output);
                    CHECK(count_lines(run_cli(call).standard_error) == 4);
                    const std::string seen = text();
                    // The warning alone is left.
                    CHECK(count_lines(run_cli(call + " --quiet").standard_error) == 1);
                    CHECK(text() == seen);
                  }});
  check_options("generate", rows);
}

TEST_CASE("generate: what holds where an option is not given") {
  if (!have_device()) return;
  const Call bare{.model = TinyPipeline::instance().model(), .seed_clips = {seed_clip(1)}};
  CHECK(by_program(bare) == by_library(bare));
}

TEST_CASE("generate: a model that was not trained to run freely is reported where it does not") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const auto messages = [&](const fs::path& model) {
    const Call call{.model = model, .seed_clips = {seed_clip(1)}, .frames = 60};
    const CliResult result = run_cli(call.arguments(folder / "out.bvh"));
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return result.standard_error;
  };
  const std::string warning = "the model was not trained to run freely",
                    what = "--preset generation";
  const std::string usual = messages(pipeline.model());
  CHECK(usual.find(warning) != std::string::npos);
  CHECK(usual.find(what) != std::string::npos);
  // This small a one hardly moves either, but it was trained for it.
  REQUIRE(train(pipeline.training_clips(), folder / "run", kTinyGreedy + " " + what).exit_code ==
          0);
  const std::string trained = messages(folder / "run/model.safetensors");
  CHECK(trained.find(" 0.5 and 1.5; ") != std::string::npos);
  CHECK(trained.find("warning") == std::string::npos);
}

TEST_CASE("generate: a seed clip that is too short is named") {
  if (!have_device()) return;
  const ScratchFolder folder;
  mcdbn::Motion clip = mcdbn::read_bvh(seed_clip(1));
  clip.channels = mcdbn::MatrixD(clip.channels.topRows(5));
  write_bvh(folder / "short.bvh", clip);
  const Call call{.model = TinyPipeline::instance().model(), .seed_clips = {folder / "short.bvh"}};
  const CliResult result = run_cli(call.arguments(folder / "out.bvh"));
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find("short.bvh") != std::string::npos);
  CHECK(result.standard_error.find("give a longer one") != std::string::npos);
  CHECK(!fs::exists(folder / "out.bvh"));
}

}  // namespace generate_options_test
