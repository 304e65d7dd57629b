// A test of more clips than the device is given at once.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "device/every_device.hpp"

namespace many_clips_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kClips = 65;

ClipFiles::Named short_clips() {
  ClipFiles::Named clips;
  for (std::size_t i = 0; i < kClips; ++i)
    clips.emplace_back(fmt::format("{:02}_01.bvh", i), paced_clip(4, 0.8 + 0.01 * i));
  return clips;
}

}  // namespace

TEST_CASE("a test run of 65 clips scores each one's 2D by its own answer") {
  const ClipFiles scene({{"s01_01.bvh", paced_clip(14, 1.0)}}, short_clips(),
                        {35, 12, std::nullopt, 45, 1920, 1080});
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options;
    options.camera = scene.model_view;
    options.fit.reset();
    options.baselines.clear();
    const auto results = run_test(model, scene.tests, options);
    REQUIRE(results.size() == kClips);
    for (const std::size_t i : {std::size_t{0}, kClips - 2, kClips - 1}) {
      CAPTURE(i);
      const ClipResult alone = run_test(model, {scene.tests[i]}, options).at(0);
      CHECK(results[i].track.track_error_px == doctest::Approx(alone.track.track_error_px));
      CHECK(results[i].track.mean_track_error_px ==
            doctest::Approx(alone.track.mean_track_error_px));
    }
    CHECK(results[0].track.track_error_px !=
          doctest::Approx(results[kClips - 1].track.track_error_px));
  });
}

}  // namespace many_clips_test
