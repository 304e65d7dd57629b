// The scale of samples, found again step by step.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/machines/regeneration.hpp"
#include "motion_model/clip_scene.hpp"
#include "motion_model/sample_calibration.hpp"

namespace calibration_reference_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Joints about the root, which stands still. @return [frames x 3·joints]
MatrixD positions(const Modalities& modalities, const MatrixF& pose) {
  const PoseFeatures& features = modalities.pose_features;
  return joint_positions(features.decode(modalities.pose_scale.invert(pose),
                                         Eigen::Matrix3d::Identity(), features.skeleton(), 30.0,
                                         MatrixD::Zero(pose.rows(), 3)));
}

double distance(const MatrixD& x, const MatrixD& y) {
  double sum = 0;
  for (Eigen::Index t = 0; t < x.rows(); ++t)
    for (Eigen::Index c = 0; c < x.cols(); c += 3)
      sum += (x.block<1, 3>(t, c) - y.block<1, 3>(t, c)).norm();
  return sum;
}

/// Σ distances of samples drawn with that scale from the answers, for each of the four.
double strayed(const Mcdbn& network, const RandomClips& scene, const std::vector<MatrixF>& answers,
               std::size_t clips_in_step, double scale) {
  RegenerationOptions options;
  options.samples = 4;
  options.temperature = 1.0;
  options.sampling = {.gibbs_steps = 0,
                      .mrbm_gibbs_steps = network.mean_field_steps,
                      .steady = true,
                      .scale = scale};
  double sum = 0;
  for (std::size_t first = 0; first < answers.size(); first += clips_in_step, ++options.seed) {
    const auto begin = scene.tracks.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = std::min(clips_in_step, answers.size() - first);
    const auto samples = regenerate(
        network, std::vector<MatrixF>(begin, begin + static_cast<std::ptrdiff_t>(count)), options);
    for (std::size_t i = 0; i < samples.size(); ++i)
      sum += 0.25 * distance(positions(scene.modalities, samples[i]),
                             positions(scene.modalities, answers[first + i / 4]));
  }
  return sum;
}

/// At temperature 1 samples stray from the single answer half as far as that is off.
double scale_by_halving(const Mcdbn& network, const RandomClips& scene, std::size_t clips_in_step) {
  const auto answers = regenerate(network, scene.tracks);
  double wanted = 0;
  for (std::size_t i = 0; i < answers.size(); ++i)
    wanted += 0.5 * distance(positions(scene.modalities, answers[i]),
                             positions(scene.modalities, scene.poses[i]));
  double scale = 1.0;
  for (double step = 0.5; step > 0.01; step /= 2)
    scale += strayed(network, scene, answers, clips_in_step, scale) > wanted ? -step : step;
  return scale;
}

}  // namespace

TEST_CASE("the scale of samples is where they stray half as far as the answers are off") {
  on_every_device([](Device& device) {
    RandomClips scene({17, 8, 11});
    Mcdbn network = random_network(device, scene.modalities);
    std::vector<double> scales;
    const auto usual = regenerate(network, scene.tracks);
    for (const float error : {0.06F, 0.12F}) {
      // Poses near the answers and further from them.
      const auto noise = scene.poses;
      for (std::size_t i = 0; i < noise.size(); ++i) scene.poses[i] = usual[i] + error * noise[i];
      const SamplingRule rule =
          calibrated_sampling(network, scene.modalities, scene.tracks, scene.poses);
      CHECK(rule.scale == scale_by_halving(network, scene, 3));
      CHECK(rule.gibbs_steps == 0);
      CHECK(rule.mrbm_gibbs_steps == 4);
      CHECK(rule.steady);
      scales.push_back(rule.scale);
      scene.poses = noise;
    }
    CHECK(scales[0] != scales[1]);
    for (const double scale : scales) {
      CHECK(scale > 0.05);  // not at either end, where every rule would be right
      CHECK(scale < 1.95);
    }
    network.mean_field_steps = 0;
    CHECK(calibrated_sampling(network, scene.modalities, scene.tracks, scene.poses)
              .mrbm_gibbs_steps == 1);
  });
}

TEST_CASE(
    "the scale of samples of more frames than are answered in step: each batch is drawn for "
    "itself") {
  on_every_device([](Device& device) {
    // 1,200 frames of four samples are answered in step, which are 48 of these clips.
    RandomClips scene(std::vector<std::size_t>(100, 25));
    const Mcdbn network = random_network(device, scene.modalities);
    const auto usual = regenerate(network, scene.tracks);
    for (std::size_t i = 0; i < usual.size(); ++i)
      scene.poses[i] = usual[i] + 0.4F * scene.poses[i];
    const double scale =
        calibrated_sampling(network, scene.modalities, scene.tracks, scene.poses).scale;
    CHECK(scale == scale_by_halving(network, scene, 48));
    CHECK(scale != scale_by_halving(network, scene, 100));  // the draws are part of it
  });
}

TEST_CASE("calibration looks at every so many clips once they are longer than ten minutes") {
  on_every_device([](Device& device) {
    RandomClips scene({17, 8, 11});
    const Mcdbn network = random_network(device, scene.modalities);
    const auto answers = regenerate(network, scene.tracks);
    for (std::size_t i = 0; i < 3; ++i)
      scene.poses[i] = answers[i] + 0.12F * static_cast<float>(i + 1) * scene.poses[i];
    const auto scale_of = [&](double fps, const std::vector<std::size_t>& clips) {
      Modalities modalities = scene.modalities;
      modalities.fps = fps;
      std::vector<MatrixF> tracks, poses;
      for (const std::size_t i : clips) {
        tracks.push_back(scene.tracks[i]);
        poses.push_back(scene.poses[i]);
      }
      return calibrated_sampling(network, modalities, tracks, poses).scale;
    };
    // 36 frames are exactly ten minutes at 0.06 a second, and more at less.
    CHECK(scale_of(0.0601, {0, 1, 2}) == scale_of(30, {0, 1, 2}));
    CHECK(scale_of(0.0599, {0, 1, 2}) == scale_of(30, {0, 2}));
    CHECK(scale_of(0.0299, {0, 1, 2}) == scale_of(30, {0}));
    CHECK(scale_of(30, {0, 1, 2}) != scale_of(30, {0, 2}));
    CHECK(scale_of(30, {0}) != scale_of(30, {0, 2}));
  });
}

}  // namespace calibration_reference_test
