// Trainings that start from a model.
#include "mcdbn/motion_model/training_start.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "corpus/training_files.hpp"
#include "device/every_device.hpp"
#include "learning/small_network.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/run_folder.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_run.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace training_start_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

TrainingConfig small_config() {
  TrainingConfig config;
  config.seed = 5;
  config.fps = 25;
  config.hidden = 8;
  config.mrbm_hidden = 6;
  config.order = 2;
  config.look_ahead = 2;
  config.augment.views = 2;
  config.fine_tuning.from_greedy = false;
  config.fine_tuning.steps = 3;
  config.fine_tuning.windows = 4;
  config.fine_tuning.window_frames = 4;
  return config;
}

/// One person's walk and a model of it, and another's walk.
struct Scene {
  TrainingFiles walks{{{1, 1, 30.0, 1.2}, {2, 1, 30.0, 1.0}}};
  TrainingConfig config = small_config();
  ClipStore first = load_clips({walks.files()[0]}), second = load_clips({walks.files()[1]});

  Model model(Device& device) const {
    return train_model(device, make_training_set(first, config), first, config).model;
  }
};

Eigen::VectorXd parameters(const Mcdbn& network) {
  return in_double(on_host(network)).flattened();
}

TrainingConfig with(TrainingConfig config, const std::function<void(TrainingConfig&)>& change) {
  change(config);
  return config;
}

}  // namespace

TEST_CASE("a training from a model begins with its parameters, in its features and scaling") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model start = scene.model(device);
    // Next to nothing is learnt in one mini-batch of such a rate.
    const TrainingConfig still = with(scene.config, [](TrainingConfig& config) {
      config.fine_tuning.steps = 1;
      config.fine_tuning.rate = 1e-12;
      config.fine_tuning.weight_decay = 0;
      config.seed = 9;
    });
    const TrainingSet data = make_training_set(scene.second, start.modalities, still);
    CHECK(data.modalities.pose_scale.mean() == start.modalities.pose_scale.mean());
    CHECK(data.modalities.track_scale.deviation() == start.modalities.track_scale.deviation());
    const Model same = train_model(device, data, scene.second, still, {}, &start).model;
    const Eigen::VectorXd before = parameters(start.network), after = parameters(same.network),
                          anew = parameters(
                              train_model(device, data, scene.second, still).model.network);
    REQUIRE(before.size() == after.size());
    CHECK((before - after).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((before - anew).cwiseAbs().maxCoeff() > 0.1);

    const Model learnt = train_model(device, data, scene.second, scene.config, {}, &start).model;
    CHECK(parameters(learnt.network) != before);
    // What either was trained on is no test.
    REQUIRE(learnt.training_clips.size() == 2);
    CHECK(learnt.training_clips[0].path == scene.first.record(0).clip.path);
    CHECK(learnt.training_clips[1].path == scene.second.record(0).clip.path);
    // Learnt again it is listed once.
    const Model again = train_model(device, data, scene.second, still, {}, &learnt).model;
    REQUIRE(again.training_clips.size() == 2);
    CHECK(again.training_clips[0].path == scene.first.record(0).clip.path);
    CHECK(again.training_clips[1].path == scene.second.record(0).clip.path);
  });
}

TEST_CASE("what has to be as in the model is named where it is not") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model start = scene.model(device);
    TrainingConfig taken;
    assign_settings(taken, settings_of_start(start));
    CHECK(taken.fps == 25);
    CHECK(taken.hidden == 8);
    CHECK(taken.mrbm_hidden == 6);
    CHECK(taken.order == 2);
    CHECK(taken.look_ahead == 2);
    CHECK(taken.augment.views == TrainingConfig().augment.views);
    CHECK_NOTHROW(check_start(start, scene.config));
    const auto refused = [&](const std::string& words,
                             const std::function<void(TrainingConfig&)>& change) {
      CAPTURE(words);
      const TrainingConfig config = with(scene.config, change);
      CHECK_THROWS_WITH_AS(check_start(start, config), doctest::Contains(words.c_str()),
                           ConfigError);
    };
    refused("`hidden` is 9, but 8", [](TrainingConfig& c) { c.hidden = 9; });
    refused("`order`", [](TrainingConfig& c) { c.order = 3; });
    refused("`layers`", [](TrainingConfig& c) { c.layers = 2; });
    refused("`mrbm-hidden`", [](TrainingConfig& c) { c.mrbm_hidden = 7; });
    refused("`look-ahead`", [](TrainingConfig& c) { c.look_ahead = 1; });
    refused("`fps`", [](TrainingConfig& c) { c.fps = 30; });
    refused("`camera.azimuth`", [](TrainingConfig& c) { c.camera.azimuth_deg = 12; });
    refused("fine-tuning alone", [](TrainingConfig& c) { c.fine_tuning.from_greedy = true; });
    refused("fine-tuning alone", [](TrainingConfig& c) { c.fine_tuning.steps = 0; });
    refused("own skeleton", [](TrainingConfig& c) { c.skeleton = SkeletonUse::humanoid; });
    refused("own skeleton", [](TrainingConfig& c) { c.augment.leaning = 0.1; });
    Model wider = start;
    wider.network.cdbns.pop_back();
    wider.network.cdbns.push_back(wider.network.cdbns.front());
    wider.network.cdbns[1].layers.push_back(wider.network.cdbns[1].layers.front());
    CHECK_THROWS_AS(check_start(wider, scene.config), ConfigError);
    // A clip that lacks a joint of the model's.
    Motion other = scene.second.motion(0);
    other.skeleton.joints.back().name = "something";
    CHECK_THROWS_AS(
        make_training_set(std::vector<LoadedClip>{{{}, other}}, start.modalities, scene.config),
        InputError);
  });
}

TEST_CASE("a run folder keeps the model that its training starts from, and the model records it") {
  const Scene scene;
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    const auto file = folder / "start.safetensors", run_folder = folder / "run";
    save_model(file, scene.model(device));
    const std::vector<ListedClip> clips{{scene.walks.files()[1]}};
    {
      const RunFolder begun = RunFolder::begin(run_folder, scene.config, clips, true, file);
      REQUIRE(begun.started_from());
    }
    const std::string bytes = read_text_file(file);
    std::filesystem::remove(file);  // it is no longer needed
    RunFolder run = RunFolder::resume(run_folder);
    REQUIRE(run.started_from());
    CHECK(run.started_from()->model == file.string());
    CHECK(read_text_file(run.start_model()) == bytes);
    const Model start = load_model(device, run.start_model());
    const TrainingSet data = make_training_set(scene.second, start.modalities, run.config());
    train_to_folder(device, data, scene.second, run, {}, {}, &start);
    const Model trained = load_model(device, run.model());
    REQUIRE(trained.started_from);
    CHECK(trained.started_from->model == file.string());
    CHECK(trained.started_from->fingerprint == run.started_from()->fingerprint);
    CHECK(describe_model(run.model()).at("started_from") == "start.safetensors");
    CHECK_FALSE(start.started_from);
  });
}

}  // namespace training_start_test
