#include "comparison/training_views.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "comparison/clip_files.hpp"
#include "comparison/fitted_baseline.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

namespace training_views_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

Motion walk(int clip = 1) {
  SynthesisOptions options;
  options.clip = clip;
  options.seconds = 1.0;
  options.fps = 30;
  return synthesize(options);
}

bool same(const std::vector<MatrixF>& x, const std::vector<MatrixF>& y) {
  return std::ranges::equal(x, y, [](const MatrixF& a, const MatrixF& b) {
    return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
  });
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

TEST_CASE("views made again have the people and actions that the training clips had") {
  // All are of one body.
  const ClipFiles clips({{"a.bvh", walk(1)}, {"b.bvh", walk(2)}, {"c.bvh", walk(3)}}, {}, {});
  TrainingConfig config;
  config.hold_out_among = 2;
  config.fine_tuning.view_uses = 4;
  config.fine_tuning.window_frames = 1000;  // fewer views
  std::vector<LoadedClip> loaded = load_clips(clips.training);
  for (LoadedClip& clip : loaded) clip.clip.person = "ann";
  loaded[2].clip.person = "bob";
  loaded[0].clip.action = "stroll";
  on_every_device([&](Device& device) {
    Model model = clips.model(device);
    model.config = settings_json(config);
    const auto made_again = [&] {
      TestRunOptions run;
      run.baselines = {"mlp_window"};
      add_training_views(model, run);
      return run;
    };
    const TestRunOptions by_bones = made_again();
    REQUIRE_FALSE(by_bones.view_poses.empty());
    for (std::size_t i = 0; i < loaded.size(); ++i) model.training_clips[i] = loaded[i].clip;
    const TrainingSet wanted = some_fresh_views(loaded, model.modalities, config);
    const TestRunOptions found = made_again();
    CHECK(same(found.view_poses, wanted.poses));
    CHECK(same(found.view_tracks, wanted.tracks));
    CHECK_FALSE(same(found.view_poses, by_bones.view_poses));
  });
}

}  // namespace training_views_test
