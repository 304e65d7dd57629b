// A model's training clip that is gone, where baselines are to be fitted on it.

#include <doctest/doctest.h>

#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace missing_training_clip_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("a test run reports a training clip that is gone before it does anything else") {
  const ClipFiles scene({{"08_01.bvh", swinging(small_body(), 14)}},
                        {{"09_01.bvh", swinging(small_body(), 12)}}, {});
  on_every_device([&](Device& device) {
    Model model = scene.model(device);
    model.training_clips.push_back(model.training_clips.front());
    model.training_clips.back().path = scene.folder / "gone.bvh";
    TestRunOptions options;
    options.fit.reset();
    options.regeneration.run_in = 4;
    options.baselines = {"mean_pose"};
    int done = 0;
    options.progress = [&](const std::string&, double) { ++done; };
    CHECK_THROWS_WITH_AS(run_test(model, scene.tests, options),
                         doctest::Contains("gone.bvh: a training clip of the model is gone; "
                                           "baselines are fitted on it, so put it back or take no "
                                           "baselines (`baselines` none)"),
                         InputError);
    CHECK(done == 0);
    options.baselines.clear();
    CHECK(run_test(model, scene.tests, options).size() == 1);
  });
}

}  // namespace missing_training_clip_test
