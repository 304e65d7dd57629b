// The figures of an evaluation from the motions themselves, by code of the tests' own.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/capture_bound.hpp"
#include "comparison/comparison_run.hpp"
#include "independent_scores.hpp"
#include "library_calls.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

void check_scores(const std::map<std::string, double>& wanted, const json& found,
                  double tolerance) {
  CHECK(found.size() == wanted.size());
  for (const auto& [name, value] : wanted) {
    CAPTURE_BOUND(name);
    REQUIRE(found.contains(name));
    const double off = std::abs(found.at(name).get<double>() - value);
    CHECK(off <= tolerance * std::max(1.0, std::abs(value)));
  }
}

json figures_of(const mcdbn::ClipScore& score) {
  json figures = {{"foot_slide_of_truth_mm_s", score.foot_slide.truth_mm_s}};
  for (const mcdbn::ScoreFigure& figure : mcdbn::score_figures())
    figures[figure.name] = figure.of(score);
  return figures;
}

}  // namespace

TEST_CASE("the scores of every method are those of its motion, by independent code") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const mcdbn::Model model = load_model(usual_device(), pipeline.model());
  mcdbn::TestRunOptions options;
  options.camera = model.modalities.camera;
  options.regeneration.samples = 2;
  options.regeneration.temperature = 1;
  for (const mcdbn::ClipResult& result :
       run_test(model, {pipeline.motion() / "walk_s02_01.bvh"}, options)) {
    const auto check = [&](const mcdbn::ScoredAnswer& answer) {
      const auto wanted = independent_scores(result.truth.motion, answer.motion,
                                             result.truth.camera.camera_from_world);
      json figures = figures_of(answer.score);
      figures.erase("within_90");  // of drawn motions: uncertainty_run_test.cpp has it by hand
      // Sums of a few thousand terms in double.
      check_scores(wanted, figures, 1e-9);
    };
    CHECK(result.samples.size() == 2);
    CHECK(result.other_answers.size() == 6);
    for (const mcdbn::ScoredAnswer& sample : result.samples) check(sample);
    for (const auto& [name, other] : result.other_answers) {
      CAPTURE_BOUND(name);
      check(other);
    }
  }
}

TEST_CASE("evaluate scores what regenerate writes, against the test clip's own file") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path clip = pipeline.motion() / "walk_s02_02.bvh";
  // The tiny model was trained for the usual view, which project has too.
  const std::string camera = (folder / "camera.yaml").string();
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}'", clip.string(),
                              (folder / "track.csv").string(), camera))
              .exit_code == 0);
  REQUIRE(run_cli(fmt::format("regenerate --model '{}' --input '{}' -o '{}' --camera '{}' "
                              "--skeleton '{}' --fit none",
                              pipeline.model().string(), (folder / "track.csv").string(),
                              (folder / "out.bvh").string(), camera, clip.string()))
              .exit_code == 0);
  const CliResult result =
      run_cli(fmt::format("evaluate --model '{}' --test '{}' --fit none --json --quiet",
                          pipeline.model().string(), clip.string()));
  REQUIRE(result.exit_code == 0);
  const auto wanted = independent_scores(mcdbn::read_bvh(clip), mcdbn::read_bvh(folder / "out.bvh"),
                                         mcdbn::read_camera(camera).camera_from_world);
  auto found = json::parse(result.standard_output).at("model");
  // Files hold five digits or so of a motion; accelerations are its second differences times 900.
  const double acceleration = wanted.at("acceleration_error_mm_s2");
  CHECK(found.at("acceleration_error_mm_s2").get<double>() ==
        doctest::Approx(acceleration).epsilon(0.02));
  found["acceleration_error_mm_s2"] = acceleration;
  const double within =
      found.at("within_90");  // the network gives its uncertainty, without a fit too
  CHECK(within > 0);
  CHECK(within < 1);
  found.erase("within_90");
  check_scores(wanted, found, 2e-3);
}
