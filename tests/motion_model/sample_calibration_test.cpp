#include "motion_model/sample_calibration.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "features/small_figure.hpp"
#include "learning/random_start.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace sample_calibration_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A small network with random weights, and smooth tracks for it.
struct CalibrationScene {
  CalibrationScene() {
    config.order = 2;
    config.layers = 2;
    config.hidden = config.mrbm_hidden = 24;
    config.look_ahead = 1;
    for (const Eigen::Index frames : {40, 23}) {
      MatrixF track(frames, figure.modalities().track_scale.output_dimension());
      for (Eigen::Index t = 0; t < frames; ++t)
        for (Eigen::Index c = 0; c < track.cols(); ++c)
          track(t, c) = std::sin(0.1F * static_cast<float>(t) + static_cast<float>(c * frames));
      tracks.push_back(track);
    }
  }
  Mcdbn network(Device& device) const {
    const auto columns = [](const Standardizer& scale) {
      return static_cast<std::size_t>(scale.output_dimension());
    };
    return random_start(device,
                        {{"track", columns(figure.modalities().track_scale), VisibleKind::gaussian},
                         {"pose", columns(figure.modalities().pose_scale), VisibleKind::gaussian}},
                        config);
  }

  SmallFigure figure;
  TrainingConfig config;
  std::vector<MatrixF> tracks;
};

RegenerationOptions sampled(const SamplingRule& rule, std::size_t samples) {
  RegenerationOptions options;
  options.samples = samples;
  options.temperature = 1.0;
  options.sampling = rule;
  return options;
}

/// Mean distance in the standardized features.
double mean_distance(const MatrixF& x, const MatrixF& y) {
  return static_cast<double>((x - y).norm()) / std::sqrt(static_cast<double>(x.rows()));
}

/// Of the change from frame to frame to the next, what a tremor is made of.
double tremor(const MatrixF& x) {
  const auto inner = x.rows() - 2;
  return static_cast<double>(
      (x.bottomRows(inner) - 2.0F * x.middleRows(1, inner) + x.topRows(inner)).norm());
}

}  // namespace

TEST_CASE("samples stray further where the network's answers are further from the clips") {
  const CalibrationScene scene;
  on_every_device([&](Device& device) {
    const Mcdbn network = scene.network(device);
    const auto answers = regenerate(network, scene.tracks);
    const auto scale_for = [&](float error) {
      std::vector<MatrixF> poses = answers;
      for (MatrixF& pose : poses) pose += error * MatrixF::Random(pose.rows(), pose.cols());
      const SamplingRule rule =
          calibrated_sampling(network, scene.figure.modalities(), scene.tracks, poses);
      CHECK(rule.steady);
      CHECK(rule.gibbs_steps == 0);
      CHECK(rule.mrbm_gibbs_steps == network.mean_field_steps);
      return rule.scale;
    };
    CHECK(scale_for(0.0F) < 0.05);
    const double near = scale_for(0.1F), far = scale_for(0.2F);
    CHECK(near > 0.05);
    CHECK(far > 1.5 * near);
    CHECK(far < 2.0);
    CHECK(scale_for(30.0F) > 1.9);
  });
}

TEST_CASE("steady samples differ from each other and do not tremble, drawn anew they do") {
  const CalibrationScene scene;
  on_every_device([&](Device& device) {
    const Mcdbn network = scene.network(device);
    SamplingRule rule{.gibbs_steps = 0, .mrbm_gibbs_steps = 2, .steady = true};
    const MatrixF answer = regenerate(network, scene.tracks)[0];
    const auto steady = regenerate(network, scene.tracks, sampled(rule, 3));
    REQUIRE(steady.size() == 6);
    CHECK(mean_distance(steady[0], steady[1]) > 0.1 * answer.norm() / std::sqrt(answer.rows()));
    for (std::size_t i = 0; i < 3; ++i) CHECK(tremor(steady[i]) < 3.0 * tremor(answer));
    rule.steady = false;
    for (const MatrixF& sample : regenerate(network, {scene.tracks[0]}, sampled(rule, 3)))
      CHECK(tremor(sample) > 10.0 * tremor(answer));
  });
}

TEST_CASE("calibration wants a pose for each track") {
  const CalibrationScene scene;
  on_every_device([&](Device& device) {
    CHECK_THROWS_AS(
        calibrated_sampling(scene.network(device), scene.figure.modalities(), scene.tracks, {}),
        ShapeError);
  });
}

}  // namespace sample_calibration_test
