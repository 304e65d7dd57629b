#include "comparison/training_views.hpp"

#include <doctest/doctest.h>

#include "comparison/clip_files.hpp"
#include "comparison/fitted_baseline.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

namespace training_views_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

Motion walk() {
  SynthesisOptions options;
  options.seconds = 1.0;
  options.fps = 30;
  return synthesize(options);
}

}  // namespace

TEST_CASE("views of fine-tuning are made again for the baseline that learns from them alone") {
  const ClipFiles clips({{"walk_s01_01.bvh", walk()}}, {}, {});
  on_every_device([&](Device& device) {
    Model model = clips.model(device);
    TrainingConfig config;
    config.augment.views = 1;
    model.config = settings_json(config);
    const auto views_for = [&](std::vector<std::string> baselines) {
      TestRunOptions run;
      run.baselines = std::move(baselines);
      add_training_views(model, run);
      CHECK(run.view_poses.size() == run.view_tracks.size());
      return run.view_tracks.size();
    };
    CHECK(views_for({}) == 0);
    CHECK(views_for({"mean_pose", "nearest_neighbour", "ridge_window"}) == 0);
    CHECK(views_for({"mean_pose", "mlp_window"}) == 1);

    const BaselineTrainingData nearest = training_data_of("nearest_neighbour", model),
                               perceptron = training_data_of("mlp_window", model);
    CHECK(nearest.tracks.size() == 1);
    CHECK(nearest.view_tracks.empty());
    CHECK(perceptron.tracks == nearest.tracks);
    CHECK(perceptron.view_tracks.size() == 1);

    // A clip that became unreadable is in nobody's way who needs none.
    clips.folder.write("walk_s01_01.bvh", "no motion");
    CHECK(views_for({}) == 0);
    CHECK_THROWS_AS(views_for({"mlp_window"}), InputError);
    clips.write("walk_s01_01.bvh", walk());
  });
}

}  // namespace training_views_test
