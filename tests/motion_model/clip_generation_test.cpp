// From a seed clip to clips that go on from it: frames, rates, the root's path, every option.

#include "mcdbn/motion_model/clip_generation.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/resample.hpp"
#include "motion_model/clip_scene.hpp"

namespace clip_generation_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Scene {
  CameraPlacement view{35, 12, std::nullopt, 45, 1920, 1080};
  Modalities modalities = modalities_of({swinging(small_body(), 60)}, view);

  Model model(Device& device) const {
    return {random_network(device, modalities), modalities, {}, {}};
  }
};

GenerationOptions some_options() {
  GenerationOptions options;
  options.frames = 20;
  options.samples = 2;
  options.gibbs_steps = 3;
  options.temperature = 0.9;
  options.seed = 17;
  return options;
}

/// A body of other proportions with another way to write the same joints.
Motion other_person(int frames, double fps) {
  Skeleton body = small_body();
  for (Joint& joint : body.joints) joint.offset *= 1.25;
  std::swap(body.joints[2].channels[0], body.joints[2].channels[2]);
  return swinging(body, frames, fps);
}

std::vector<Motion> generated(const Model& model, const Motion& seed,
                              const GenerationOptions& options) {
  return generate_clips(model, {{"seed", seed}}, options);
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("generate_clips: what the network makes of the seed at the model's rate, on its person") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    for (const double fps : {30.0, 47.0, 120.0}) {
      CAPTURE(fps);
      const Motion seed = other_person(90, fps);
      const GenerationOptions options = some_options();
      const auto got = generated(model, seed, options);
      const Motion at_rate = resample(seed, 30);
      const Eigen::Matrix3d camera = camera_rotation(35, 12);
      const auto poses = generate(model.network.cdbns[1],
                                  {scene.modalities.encode_pose(at_rate, camera)}, options);
      REQUIRE(got.size() == 2);
      CHECK(largest(got[0].channels - got[1].channels) > 1e-3);
      for (std::size_t i = 0; i < got.size(); ++i) {
        CHECK(got[i].frames() == 20);
        CHECK(got[i].fps() == doctest::Approx(30));
        CHECK(got[i].skeleton.joints[3].offset == seed.skeleton.joints[3].offset);
        // Orientations are the features'; where the root is does not touch them.
        const MatrixD want = scene.modalities.pose_scale.invert(poses[i]);
        const Motion there = scene.modalities.pose_features.decode(want, camera, seed.skeleton, 30,
                                                                   path_of(got[i], "Hips"));
        CHECK(largest(got[i].channels - there.channels) < 1e-6);
      }
    }
  });
}

TEST_CASE("generate_clips: the root goes on from the seed's end, by height and velocity") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    const Motion seed = other_person(90, 30);
    const GenerationOptions options = some_options();
    const Eigen::Matrix3d camera = camera_rotation(35, 12);
    const auto poses =
        generate(model.network.cdbns[1], {scene.modalities.encode_pose(seed, camera)}, options);
    const double units = file_units_per_metre(seed.skeleton);
    const auto motions = generated(model, seed, options);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const MatrixD path = path_of(motions[i], "Hips");
      const MatrixD root = scene.modalities.pose_features.root_features(
          scene.modalities.pose_scale.invert(poses[i]));
      Eigen::RowVector3d before = path_of(seed, "Hips").bottomRows(1);
      for (Eigen::Index t = 0; t < path.rows(); ++t) {
        CAPTURE(t);
        const Eigen::RowVector3d step = units / 30 * root.row(t).tail(3) * camera;
        CHECK(path(t, 0) - before.x() == doctest::Approx(step.x()).epsilon(1e-9));
        CHECK(path(t, 2) - before.z() == doctest::Approx(step.z()).epsilon(1e-9));
        CHECK(path(t, 1) == doctest::Approx(units * root(t, 0)).epsilon(1e-9));
        before = path.row(t);
      }
    }
  });
}

TEST_CASE("generate_clips: from moments all over each clip, the last of which is its end") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    const std::vector<Motion> clips = {swinging(small_body(), 70), swinging(small_body(), 40)};
    const Eigen::Matrix3d camera = camera_rotation(35, 12);
    const auto seen = [&](std::size_t clip) {
      return scene.modalities.encode_pose(clips[clip], camera);
    };
    // Every second of 30 frames; the network's order is 3.
    const std::vector<std::pair<std::size_t, int>> moments = {
        {0, 10}, {0, 40}, {0, 70}, {1, 10}, {1, 40}};
    GenerationOptions options = some_options();
    std::vector<MatrixF> before;
    for (const auto& [clip, frames] : moments)
      for (std::size_t i = 0; i < options.samples; ++i)
        before.emplace_back(seen(clip).topRows(frames));
    GenerationHealth health;
    const auto got =
        generate_clips(model, {{"a", clips[0], 1}, {"b", clips[1], 1}}, options, &health);
    options.samples = 1;
    const auto poses = generate(model.network.cdbns[1], before, options);
    REQUIRE(got.size() == poses.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i);
      const auto [clip, frames] = moments[i / 2];
      CHECK(health.seed_speed[i] == doctest::Approx(mean_speed(seen(clip))));
      const MatrixD want = scene.modalities.pose_scale.invert(poses[i]);
      const Motion there = scene.modalities.pose_features.decode(want, camera, clips[clip].skeleton,
                                                                 30, path_of(got[i], "Hips"));
      CHECK(largest(got[i].channels - there.channels) < 1e-6);
      const double units = file_units_per_metre(clips[clip].skeleton);
      const Eigen::RowVector3d step =
          units / 30 * scene.modalities.pose_features.root_features(want).row(0).tail(3) * camera;
      const Eigen::RowVector3d start = path_of(clips[clip], "Hips").row(frames - 1);
      CHECK(path_of(got[i], "Hips")(0, 0) - start.x() == doctest::Approx(step.x()).epsilon(1e-9));
    }
    // Nothing lies so long before the end; and moments are no nearer than a frame.
    CHECK(generate_clips(model, {{"b", clips[1], 60}}, options).size() == 1);
    CHECK(generate_clips(model, {{"b", clips[1], 1e-9}}, options).size() == 38);
  });
}

TEST_CASE("generate_clips: every option comes to its use, and too short a seed is refused") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    const Motion seed = swinging(small_body(), 40);
    const GenerationOptions options = some_options();
    const auto first = [&](const GenerationOptions& changed) {
      return generated(model, seed, changed).at(0).channels;
    };
    const MatrixD usual = first(options);
    CHECK(first(options) == usual);
    const auto changes = [&](auto&& change) {
      GenerationOptions changed = options;
      change(changed);
      return first(changed) != usual;
    };
    CHECK(changes([](GenerationOptions& o) { ++o.seed; }));
    CHECK(changes([](GenerationOptions& o) { o.temperature = 0.3; }));
    CHECK(changes([](GenerationOptions& o) { o.gibbs_steps = 4; }));
    GenerationOptions longer = options;
    longer.frames = 25;
    CHECK(first(longer).topRows(20) == usual);
    CHECK(first(longer).rows() == 25);
    longer.frames = 1'000'000;  // each by itself is in range
    longer.samples = 1000;
    CHECK_THROWS_AS(generated(model, seed, longer), ConfigError);
    Motion end = seed;
    end.channels = MatrixD(seed.channels.bottomRows(3));
    CHECK_NOTHROW(generated(model, end, options));
    end.channels = MatrixD(seed.channels.bottomRows(2));  // the network's order is 3
    CHECK_THROWS_AS(generated(model, end, options), InputError);
    Motion stranger = seed;
    stranger.skeleton.joints[4].name = "Tail";
    CHECK_THROWS_AS(generated(model, stranger, options), InputError);
  });
}

TEST_CASE("generate_clips: several seeds go on each on its own person, and health is of all") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    const std::vector<SeedClip> seeds{{"one", swinging(small_body(), 60)},
                                      {"other", other_person(90, 30)},
                                      {"fast", other_person(200, 120)}};
    const GenerationOptions options = some_options();
    GenerationHealth health;
    const auto got = generate_clips(model, seeds, options, &health);
    std::vector<MatrixF> features;
    for (const SeedClip& seed : seeds)
      features.push_back(
          scene.modalities.encode_pose(resample(seed.motion, 30), camera_rotation(35, 12)));
    const auto poses = generate(model.network.cdbns[1], features, options);
    REQUIRE(got.size() == 6);
    for (std::size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i);
      const Skeleton& person = seeds[i / 2].motion.skeleton;
      CHECK(got[i].skeleton.joints[3].offset == person.joints[3].offset);
      const Motion there = scene.modalities.pose_features.decode(
          scene.modalities.pose_scale.invert(poses[i]), camera_rotation(35, 12), person, 30,
          path_of(got[i], "Hips"));
      CHECK(largest(got[i].channels - there.channels) < 1e-6);
    }
    std::vector<double> speeds;  // two samples of each
    for (const MatrixF& seed : features) speeds.insert(speeds.end(), 2, mean_speed(seed));
    const GenerationHealth want = generation_health(poses, speeds);
    CHECK(health.deviation == want.deviation);
    CHECK(health.late_speed == want.late_speed);
    CHECK(health.seed_speed == want.seed_speed);
    auto with_stranger = seeds;
    with_stranger[1].motion.channels = MatrixD(seeds[1].motion.channels.topRows(2));
    CHECK_THROWS_WITH_AS(generate_clips(model, with_stranger, options),
                         doctest::Contains("other: the seed clip has 2 frames"), InputError);
  });
}

TEST_CASE("generate_clips: samples are seen from the directions that the model learnt, in turn") {
  on_every_device([&](Device& device) {
    Scene scene;
    scene.modalities.directions = 3;
    const Model model = scene.model(device);
    const std::vector<SeedClip> seeds{{"one", other_person(90, 30)},
                                      {"other", swinging(small_body(), 60)}};
    GenerationOptions options = some_options();
    options.temperature = 0;  // nothing else distinguishes samples
    options.samples = 5;
    GenerationHealth health;
    const auto got = generate_clips(model, seeds, options, &health);
    REQUIRE(got.size() == 10);
    options.samples = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(i);
      Model turned = model;
      turned.modalities.camera.azimuth_deg += 120.0 * static_cast<double>(i);
      turned.modalities.directions = 1;
      GenerationHealth alone;
      const auto want = generate_clips(turned, seeds, options, &alone);
      for (std::size_t seed = 0; seed < 2; ++seed)
        for (std::size_t sample = i; sample < 5; sample += 3) {
          CHECK(largest(got[5 * seed + sample].channels - want[seed].channels) < 1e-4);
          CHECK(health.seed_speed[5 * seed + sample] == alone.seed_speed[seed]);
        }
      if (i > 0) CHECK(largest(got[i].channels - got[0].channels) > 0.1);
    }
  });
}

}  // namespace clip_generation_test
