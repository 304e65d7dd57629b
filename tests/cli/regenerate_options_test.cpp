// Every option of regenerate, and what it changes: compared with what the library makes of the
// same.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <optional>

#include "base/text_file.hpp"
#include "comparison/fitted_baseline.hpp"
#include "library_calls.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/joint_map.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/formats/uncertainty_csv.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

namespace regenerate_options_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

struct Call {
  fs::path model, track;
  std::optional<fs::path> camera = {}, skeleton = {}, joint_map = {};
  std::optional<std::size_t> samples = {}, gibbs_steps = {}, mrbm_gibbs_steps = {};
  std::optional<double> temperature = {};
  mcdbn::AssumedView view = {};
  std::optional<std::uint64_t> seed = {};
  std::string fit = {}, to = {};

  std::string arguments(const fs::path& output) const {
    std::string text = fmt::format("regenerate --model '{}' --input '{}' -o '{}'", model.string(),
                                   track.string(), output.string());
    const auto add = [&](const char* flag, const auto& value) {
      if (value) text += fmt::format(" {} {}", flag, *value);
    };
    if (camera) text += fmt::format(" --camera '{}'", camera->string());
    if (skeleton) text += fmt::format(" --skeleton '{}'", skeleton->string());
    if (joint_map) text += fmt::format(" --joint-map '{}'", joint_map->string());
    add("--samples", samples);
    add("--gibbs-steps", gibbs_steps);
    add("--mrbm-gibbs-steps", mrbm_gibbs_steps);
    add("--temperature", temperature);
    add("--seed", seed);
    add("--camera-pitch", view.pitch_deg);
    add("--camera-roll", view.roll_deg);
    add("--camera-fov", view.field_of_view_deg);
    if (!to.empty()) text += " --to " + to;
    return fit.empty() ? text : text + " --fit " + fit;
  }
};

/// The defaults are written out here once more, as the help gives them.
std::vector<std::string> by_library(const Call& call) {
  const mcdbn::Model model = load_model(usual_device(), call.model);
  mcdbn::ClipPlacement placement;
  if (call.camera) placement.camera = mcdbn::read_camera(*call.camera);
  placement.view = call.view;
  if (call.skeleton) placement.skeleton = mcdbn::read_bvh(*call.skeleton).skeleton;
  if (call.joint_map) placement.joint_map = mcdbn::read_joint_map(*call.joint_map);
  if (call.fit == "none") placement.fit.reset();
  mcdbn::RegenerationOptions options;
  options.samples = call.samples.value_or(1);
  options.seed = call.seed.value_or(1);
  options.sampling = model.network.sampling;
  if (call.gibbs_steps) options.sampling = {*call.gibbs_steps, 0, false, 1.0};
  if (call.mrbm_gibbs_steps)
    options.sampling = {call.gibbs_steps.value_or(0), *call.mrbm_gibbs_steps, false, 1.0};
  const bool anew = call.gibbs_steps || call.mrbm_gibbs_steps;
  options.temperature = call.temperature.value_or(anew ? 1.0 : options.samples == 1 ? 0.0 : 2.0);
  std::vector<std::string> texts;
  for (const mcdbn::Motion& motion :
       regenerate_clip(model, mcdbn::read_track_csv(call.track), placement, options))
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
  const std::size_t samples = call.samples.value_or(1);
  std::vector<std::string> texts;
  for (std::size_t i = 1; i <= samples; ++i) {
    const fs::path file = folder / (samples == 1 ? "out.bvh" : fmt::format("out_{:02}.bvh", i));
    REQUIRE(fs::exists(file));
    texts.push_back(mcdbn::read_text_file(file));
  }
  CHECK(std::distance(fs::directory_iterator(folder / "."), {}) ==
        static_cast<std::ptrdiff_t>(samples));
  return texts;
}

/// Equal to the library's answer, and another answer than without the change.
void check_same(const Call& call, const std::vector<std::string>& before) {
  const auto texts = by_program(call);
  CHECK(texts == by_library(call));
  CHECK(texts != before);
}

fs::path first_test_clip() {
  return TinyPipeline::instance().motion() / "walk_s02_01.bvh";
}

/// The track with some joints called as a detector calls them, the rest by unknown names.
void make_places(const fs::path& track, const fs::path& places) {
  mcdbn::Track2d seen = mcdbn::read_track_csv(track);
  seen.keypoints.clear();
  const std::map<std::string, std::string> names{
      {"LeftUpLeg", "left_hip"},  {"RightUpLeg", "right_hip"},  {"LeftLeg", "left_knee"},
      {"RightLeg", "right_knee"}, {"LeftArm", "left_shoulder"}, {"RightArm", "right_shoulder"}};
  int others = 0;
  for (std::string& name : seen.joint_names) {
    const auto found = names.find(name);
    name = found == names.end() ? fmt::format("x{}", ++others) : found->second;
  }
  mcdbn::write_track_csv(places, seen);
}

/// A track of another number of frames, seen by a camera whose file is kept.
void make_track(const fs::path& track, const fs::path& camera, const std::string& options) {
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}' {}",
                              first_test_clip().string(), track.string(), camera.string(), options))
              .exit_code == 0);
}

}  // namespace

TEST_CASE("regenerate: every option changes what its help describes") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  make_track(folder / "track.csv", folder / "camera.yaml", "--noise-px 2");
  make_track(folder / "other.csv", folder / "other.yaml", "--camera-azimuth -50 --seed 3");
  const Call plain{.model = pipeline.model(),
                   .track = folder / "track.csv",
                   .samples = 2,
                   .temperature = 0.8,
                   .seed = 3,
                   .fit = "none"};
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
      {"--temperature",
       [&] {
         Call changed = plain;
         changed.temperature = 0.3;
         check_same(changed, before);
         changed.temperature.reset();
         check_same(changed, before);
         changed.mrbm_gibbs_steps = 1;
         check_same(changed, before);
       }},
      row("--samples", [](Call& c) { c.samples = 3; }),
      row("--gibbs-steps", [](Call& c) { c.gibbs_steps = 3; }),
      row("--mrbm-gibbs-steps", [](Call& c) { c.mrbm_gibbs_steps = 2; }),
      row("--camera", [&](Call& c) { c.camera = folder / "camera.yaml"; }),
      row("--camera-pitch", [](Call& c) { c.view.pitch_deg = 15; }),
      row("--camera-roll", [](Call& c) { c.view.roll_deg = -20; }),
      row("--camera-fov", [](Call& c) { c.view.field_of_view_deg = 70; }),
      row("--skeleton", [&](Call& c) { c.skeleton = first_test_clip(); }),
      row("--fit", [](Call& c) { c.fit = "track"; }),
      row("--input", [&](Call& c) { c.track = folder / "other.csv"; }),
      row("--model", [&](Call& c) {
        REQUIRE(train(pipeline.test_clips(), folder / "run", kTiny).exit_code == 0);
        c.model = folder / "run/model.safetensors";
      })};
  const fs::path output = folder / "named.bvh";
  Call one = plain;
  one.samples = 1;
  const auto text = [=] { return mcdbn::read_text_file(output); };
  for (const OptionRow& each : device_rows(one.arguments(output), text)) rows.push_back(each);
  rows.push_back({"--to", [&] {
                    Call same = one;
                    same.to = "pose";
                    CHECK(by_program(same) == by_program(one));  // its default
                    CHECK(run_cli(one.arguments(output) + " --to video").exit_code == 2);
                  }});
  rows.push_back({"--keep-first-frame", [&] {
                    const CliResult refused =
                        run_cli(one.arguments(output) + " --keep-first-frame");
                    CHECK(refused.exit_code == 2);
                    CHECK(refused.standard_error.find("is for --to track") != std::string::npos);
                  }});
  rows.push_back(
      {"--method", [&] {
         Call single = one;  // the answer that other methods give, too
         single.temperature.reset();
         const std::string call = single.arguments(output);
         REQUIRE(run_cli(call).exit_code == 0);
         const std::string seen = text();
         REQUIRE(run_cli(call + " --method model").exit_code == 0);
         CHECK(text() == seen);
         REQUIRE(run_cli(call + " --method mean_pose").exit_code == 0);
         const mcdbn::Model model = load_model(usual_device(), one.model);
         const auto mean = fitted_baseline("mean_pose", model, clip_training_data(model, false));
         const auto predict = [&](const mcdbn::MatrixF& seen_features) {
           return mean->predict(seen_features);
         };
         mcdbn::ClipPlacement placement;
         placement.fit = mcdbn::TrackFitSettings{};
         REQUIRE(run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' "
                                     "--method mean_pose",
                                     one.model.string(), one.track.string(), output.string()))
                     .exit_code == 0);
         const auto motions =
             regenerate_clip(model.modalities, mcdbn::read_track(one.track), placement, predict,
                             [&](const mcdbn::MatrixF& features) {
                               return std::vector<mcdbn::PosePrior>{predict(features)};
                             });
         CHECK(text() == mcdbn::bvh_text(motions.at(0)));
         CHECK(text() != seen);
         CHECK(run_cli(call + " --method nobody").exit_code == 2);
         CHECK(run_cli(call + " --to track --method mean_pose").exit_code == 2);
       }});
  // follow_test.cpp has what they do.
  for (const char* option : {"--follow", "--look-ahead", "--frames"})
    rows.push_back(
        {option, [=, &folder] {
           const std::string value = std::string(option) == "--look-ahead" ? " 1"
                                     : std::string(option) == "--frames"   ? " csv"
                                                                           : "";
           CHECK(run_cli(one.arguments(folder / "live.bvh") + " " + option + value).exit_code == 2);
         }});
  rows.push_back(
      {"--write-camera", [&] {
         const fs::path written = folder / "written.yaml";
         REQUIRE(run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' "
                                     "--camera '{}' --write-camera '{}'",
                                     one.model.string(), one.track.string(), output.string(),
                                     (folder / "camera.yaml").string(), written.string()))
                     .exit_code == 0);
         const mcdbn::Camera given = in_file_units(mcdbn::read_camera(folder / "camera.yaml"),
                                                   mcdbn::read_bvh(output).skeleton),
                             back = mcdbn::read_camera(written);
         CHECK(back.translation.isApprox(given.translation, 1e-6));
         CHECK(back.camera_from_world.isApprox(given.camera_from_world, 1e-6));
       }});
  rows.push_back(
      {"--uncertainty", [&] {
         const fs::path written = folder / "sure.csv";
         const std::string call =
             fmt::format("regenerate --model '{}' --input '{}' -o '{}'", one.model.string(),
                         one.track.string(), output.string());
         REQUIRE(run_cli(call).exit_code == 0);
         const std::string likeliest = text();
         const std::string sure = fmt::format("{} --uncertainty '{}'", call, written.string());
         REQUIRE(run_cli(sure + " --seed 5").exit_code == 0);
         CHECK(text() == likeliest);
         const mcdbn::Model model = load_model(usual_device(), one.model);
         mcdbn::ClipPlacement placement;
         placement.uncertainty_draws = {50, 5};
         mcdbn::RegenerationOptions regeneration;
         regeneration.sampling = model.network.sampling;
         mcdbn::TrackFindings findings;
         const auto motions = regenerate_clip(model, mcdbn::read_track_csv(one.track), placement,
                                              regeneration, &findings);
         write_uncertainty_csv(folder / "wanted.csv", motions.at(0), findings.uncertainty);
         const std::string five = mcdbn::read_text_file(written);
         CHECK(five == mcdbn::read_text_file(folder / "wanted.csv"));
         REQUIRE(run_cli(sure + " --seed 6").exit_code == 0);
         CHECK(mcdbn::read_text_file(written) != five);
         // The network alone gives it, too, in a shorter message.
         const CliResult alone = run_cli(sure + " --fit none --seed 5");
         CHECK(alone.exit_code == 0);
         CHECK(alone.standard_error.find("standard deviation of") != std::string::npos);
         placement.fit.reset();
         const auto unfitted = regenerate_clip(model, mcdbn::read_track_csv(one.track), placement,
                                               regeneration, &findings);
         write_uncertainty_csv(folder / "wanted.csv", unfitted.at(0), findings.uncertainty);
         CHECK(mcdbn::read_text_file(written) == mcdbn::read_text_file(folder / "wanted.csv"));
         for (const char* other : {"--samples 2", "--to track"}) {
           CAPTURE(other);
           CHECK(run_cli(sure + " " + other).exit_code == 2);
         }
       }});
  rows.push_back({"--joint-map", [&] {
                    make_places(folder / "track.csv", folder / "places.csv");
                    Call places = one;
                    places.track = folder / "places.csv";
                    const auto by_names = by_program(places);
                    const fs::path map = folder.write("map.toml", "left_knee = \"LeftFoot\"\n");
                    places.joint_map = map;
                    check_same(places, by_names);
                    folder.write("map.toml", "# nobody's\nleft_knee = 3\n");
                    const CliResult wrong = run_cli(places.arguments(output));
                    CHECK(wrong.exit_code == 3);
                    CHECK(wrong.standard_error.find("map.toml:2: left_knee: ") !=
                          std::string::npos);
                  }});
  rows.push_back({"--format", [&] {
                    const std::string seen = by_program(one).at(0);
                    CHECK(run_cli(one.arguments(output) + " --format csv").exit_code == 0);
                    CHECK(text() == seen);
                    CHECK(run_cli(one.arguments(output) + " --format openpose").exit_code == 3);
                  }});
  rows.push_back({"--fps", [&] {
                    CHECK(run_cli(one.arguments(output) + " --fps 25").exit_code == 0);
                    CHECK(mcdbn::read_bvh(output).fps() == doctest::Approx(25));
                  }});
  rows.push_back({"--image-size", [&] {
                    const std::string seen = by_program(one).at(0);
                    CHECK(run_cli(one.arguments(output) + " --image-size 3000 2000").exit_code ==
                          0);
                    CHECK(text() != seen);  // another focal length is assumed
                  }});
  rows.push_back({"--person", [&] {
                    const std::string seen = by_program(one).at(0);
                    CHECK(run_cli(one.arguments(output) + " --person 1").exit_code == 0);
                    CHECK(text() == seen);
                    CHECK(run_cli(one.arguments(output) + " --person 2").exit_code == 3);
                  }});
  rows.push_back({"--output", [&] {
                    CHECK(run_cli(one.arguments(output)).exit_code == 0);
                    CHECK(text() == by_library(one).at(0));
                  }});
  rows.push_back(
      {"--quiet", [&] {
         const std::string call = one.arguments(output);
         CHECK(count_lines(run_cli(call).standard_error) == 3);  // camera, deviation, file
         const std::string seen = text();
         CHECK(run_cli(call + " --quiet").standard_error.find(": info: ") == std::string::npos);
         CHECK(text() == seen);
       }});
  check_options("regenerate", rows);
}

TEST_CASE("regenerate: what holds where an option is not given") {
  if (!have_device()) return;
  const ScratchFolder folder;
  make_track(folder / "track.csv", folder / "camera.yaml", "--noise-px 2");
  const Call bare{.model = TinyPipeline::instance().model(), .track = folder / "track.csv"};
  const auto answer = by_program(bare);
  CHECK(answer == by_library(bare));
  Call given = bare;
  given.samples = 1;
  given.temperature = 0;
  given.seed = 77;  // nothing is drawn
  given.fit = "track";
  CHECK(answer == by_library(given));

  Call several = bare;
  several.samples = 2;
  several.fit = "none";
  given = several;
  given.temperature = 2;
  given.seed = 1;
  CHECK(by_program(several) == by_library(given));
  // Steps of both kinds; and one sample that is drawn.
  several.gibbs_steps = 2;
  several.mrbm_gibbs_steps = 3;
  CHECK(by_program(several) == by_library(several));
  Call drawn = bare;
  drawn.temperature = 0.6;
  check_same(drawn, answer);
  // Drawn anew in every frame a single answer is drawn, too.
  Call anew = bare;
  anew.gibbs_steps = 5;
  check_same(anew, answer);
  anew = bare;
  anew.mrbm_gibbs_steps = 5;
  check_same(anew, answer);
}

}  // namespace regenerate_options_test
