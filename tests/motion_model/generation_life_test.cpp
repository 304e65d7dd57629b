// A CRBM that was trained with noise on its histories walks on by itself: bounded and alive.

#include <doctest/doctest.h>

#include <algorithm>

#include "device/every_device.hpp"
#include "features/clip_modalities.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/machines/generation.hpp"
#include "mcdbn/machines/generation_health.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kFrames = 1000;

std::vector<MatrixF> walks() {
  std::vector<Motion> clips;
  for (int subject = 1; subject <= 5; ++subject)
    clips.push_back(synthesize({.subject = subject, .seed = 4, .seconds = 6}));
  const Modalities modalities = modalities_of(clips, {});
  std::vector<MatrixF> poses;
  for (const Motion& clip : clips)
    poses.push_back(modalities.encode_pose(clip, camera_rotation(30, 10)));
  return poses;
}

Cdbn trained(Device& device, const std::vector<MatrixF>& walks) {
  const Sequences visible = Sequences::from_host(device, walks);
  const CrbmShape shape{visible.values.columns(), 60, 4, VisibleKind::gaussian};
  const CdSettings settings{.gibbs_steps = 1,
                            .rate = 3e-3,
                            .rate_A = 1e-4,
                            .rate_B = 3e-3,
                            .history_noise = 1,
                            .epochs = 80};
  Cdbn cdbn;
  cdbn.layers.push_back(train_crbm(
      device, visible, CrbmParameters::random(shape, 0.01, {5, 0, 0, 0x7100}), settings, {}, 0));
  return cdbn;
}

/// Goes on from the middle of each walk.
GenerationHealth health_of(const Cdbn& cdbn, const std::vector<MatrixF>& walks) {
  std::vector<MatrixF> seeds;
  for (const MatrixF& walk : walks) seeds.emplace_back(walk.topRows(walk.rows() / 2));
  GenerationOptions options;
  options.frames = kFrames;
  options.gibbs_steps = 5;
  return generation_health(generate(cdbn, seeds, options));
}

}  // namespace

TEST_CASE("generation walks on for 1,000 frames after a training with noise on histories") {
  const auto walks = ::walks();
  const GenerationHealth real = generation_health(walks);
  const std::size_t stride = *std::min_element(real.cycle.begin(), real.cycle.end());
  REQUIRE(stride > 25);  // at 30 frames a second
  on_every_device([&](Device& device) {
    const GenerationHealth health = health_of(trained(device, walks), walks);
    CHECK(health.deviation.minCoeff() > 0.5);
    CHECK(health.deviation.maxCoeff() < 1.5);
    for (std::size_t i = 0; i < walks.size(); ++i) {
      CAPTURE(i);
      CHECK(health.late_speed[i] > 0.5 * real.late_speed[i]);
      CHECK(health.late_speed[i] < 1.5 * real.late_speed[i]);
      CHECK(health.cycle[i] >= stride);
    }
  });
}
