// Views that give way to fresh ones on the way: what a mini-batch is drawn from hangs on its
// number.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "corpus/fresh_views.hpp"
#include "corpus/training_files.hpp"
#include "learning/clip_weights.hpp"
#include "learning/small_network.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace fresh_view_source_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Scene {
  TrainingFiles walks{{{1, 1, 30.0, 2.0}, {2, 1, 30.0, 1.5}}};
  ClipStore clips = load_clips(walks.files());
  TrainingConfig config = settings();
  TrainingSet data = make_training_set(clips, config);

  static TrainingConfig settings() {
    TrainingConfig config;
    config.seed = 7;
    config.augment.views = 4;
    config.fine_tuning.windows = 6;
    config.fine_tuning.view_uses = 12;  // a fresh view every two mini-batches
    return config;
  }
};

std::vector<MatrixF> contents(const FreshViewSource& source) {
  std::vector<MatrixF> all;
  for (const ModalityClips& modality : source.sequences().modalities)
    for (const auto& part : {modality.clips, modality.seen})
      all.insert(all.end(), part.begin(), part.end());
  return all;
}

bool equal(const std::vector<MatrixF>& x, const std::vector<MatrixF>& y) {
  return std::ranges::equal(x, y, [](const MatrixF& a, const MatrixF& b) {
    return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
  });
}

/// Clips of the first modality that are the same in both.
std::size_t kept(const std::vector<MatrixF>& x, const std::vector<MatrixF>& y, std::size_t count) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < count; ++i) same += x[i].rows() == y[i].rows() && x[i] == y[i];
  return same;
}

}  // namespace

TEST_CASE("the views of a mini-batch are the same whatever came before it") {
  const Scene scene;
  const FreshViewSource steps(scene.clips, scene.data, scene.config);
  const std::size_t count = steps.sequences().count();
  CHECK(count == fresh_views_at_once(scene.clips, scene.config));
  CHECK(count == 8);  // four of each clip, which is one piece
  CHECK_NOTHROW(steps.sequences().check());
  std::vector<std::vector<MatrixF>> seen{contents(steps)};
  for (std::size_t step = 1; step < 40; ++step) {
    CAPTURE(step);
    CHECK(steps.renew(step) == (step % 2 == 0));
    seen.push_back(contents(steps));
    CHECK(kept(seen[step], seen[step - 1], count) == count - (step % 2 == 0));
  }
  CHECK(steps.lifetime() >= 16);
  CHECK(steps.lifetime() <= 18);
  CHECK(kept(seen[steps.lifetime()], seen[0], count) == 0);
  for (const std::size_t step : {0U, 1U, 7U, 39U, 12U}) {
    CAPTURE(step);
    const FreshViewSource resumed(scene.clips, scene.data, scene.config);
    resumed.renew(step);
    CHECK(equal(contents(resumed), seen[step]));
    steps.renew(step);  // and back again
    CHECK(equal(contents(steps), seen[step]));
  }
}

TEST_CASE("people that fresh views are drawn from by one power are weighed for another") {
  const Scene scene;
  // Each clip is another person's.
  const double first_s = scene.clips.record(0).seconds(),
               second_s = scene.clips.record(1).seconds();
  REQUIRE(first_s > 1.2 * second_s);
  for (const double drawn : {0.0, 0.5, 1.0}) {
    CAPTURE(drawn);
    TrainingConfig config = scene.config;
    config.fine_tuning.people_power = drawn;
    config.augment.views = 10;
    const FreshViewSource source(scene.clips, scene.data, config);
    source.renew(20);  // some of the first views have given way
    const FreshViews views(scene.clips, scene.data.modalities, config, scene.data.new_poses,
                           config.seed,
                           {.frames = frames_of_pieces(config), .groups_power = drawn});
    const SynchronizedClips clips = source.sequences();
    for (const double power : {0.0, 0.5, 1.0}) {
      CAPTURE(power);
      const std::vector<double> weights = clip_weights(clips, power);
      REQUIRE(weights.size() == clips.count());
      int of_first = 0;
      for (std::size_t number = 10; number < 10 + clips.count(); ++number) {
        const std::size_t place = number % clips.count();
        const EncodedView view = views.make(number);
        REQUIRE(clips.modalities[kPose].clips[place] == view.pose);
        of_first += view.clip == 0;
        // A person's views are drawn as frames^drawn: this is left of frames^power.
        const double seconds = view.clip == 0 ? first_s : second_s;
        CHECK(weights[place] == doctest::Approx(std::pow(seconds * config.fps, power - drawn)));
      }
      CHECK(of_first > 0);
      CHECK(of_first < static_cast<int>(clips.count()));
    }
  }
}

TEST_CASE("the greedy stages on fresh views weigh people by their own power") {
  const Scene scene;
  LearningSettings settings;
  settings.hidden = settings.mrbm_hidden = 4;
  settings.order = settings.look_ahead = 1;
  settings.gaussian.epochs = 1;
  settings.gaussian.gibbs_steps = 1;
  settings.least_batches = 2;
  const FreshViewSource views(scene.clips, scene.data, scene.config);
  on_every_device([&](Device& device) {
    const auto trained = [&](double power) {
      settings.people_power = power;
      return train_greedy(device, views, settings).cdbns[kPose].layers[0].W.to_host();
    };
    CHECK(trained(1.0) != trained(0.0));
  });
}

TEST_CASE("fresh views are learnt from where they are asked for") {
  const Scene scene;
  TrainingConfig config = scene.config;
  CHECK(learns_from_fresh_views(scene.clips, config));
  config.fine_tuning.view_uses = 0;
  CHECK_FALSE(learns_from_fresh_views(scene.clips, config));
  // More than can be kept.
  std::vector<ClipRecord> many(70, {{}, {}, 1.0 / 30, 3000});
  CHECK(learns_from_fresh_views(ClipStore(many, nullptr), config));
  CHECK(fresh_views_at_once(ClipStore(many, nullptr), config) == 400);
  config.fine_tuning.steps = 0;
  CHECK_FALSE(learns_from_fresh_views(ClipStore(many, nullptr), config));
}

TEST_CASE("of several people one is held out of them, and judges by the same views always") {
  const Scene scene;
  TrainingConfig config = scene.config;
  CHECK_FALSE(FreshViewSource(scene.clips, scene.data, config).held_out_views());
  config.hold_out_among = 2;
  const FreshViewSource source(scene.clips, scene.data, config),
      again(scene.clips, scene.data, config);
  REQUIRE(source.held_out_views());
  const TrainingSet& held_out_views = *source.held_out_views();
  for (const TrainingClip& clip : held_out_views.clips)
    CHECK(clip.path == scene.clips.record(1).clip.path);  // the person with the least data
  REQUIRE(held_out_views.poses.size() == again.held_out_views()->poses.size());
  CHECK(held_out_views.poses[3] == again.held_out_views()->poses[3]);
  CHECK(held_out_views.tracks[3] == again.held_out_views()->tracks[3]);
}

TEST_CASE("the record of who was held out has all of the person's clips, drawn or not") {
  // More clips than the person has views.
  std::vector<LoadedClip> clips = load_clips(TrainingFiles{{{1, 1, 30.0, 1.0}}}.files());
  const LoadedClip clip = clips.front();
  constexpr int kClips = 40;
  for (int i = 0; i < kClips; ++i) {
    clips.push_back(clip);
    clips.back().clip.path = "/folder/" + std::to_string(i) + ".bvh";
    clips.back().clip.person = "stranger";
  }
  TrainingConfig config = Scene::settings();
  config.hold_out_among = 2;  // the one with several clips
  config.hidden = config.mrbm_hidden = 4;
  config.order = config.look_ahead = 1;
  config.augment.views = 1;
  config.fine_tuning.from_greedy = false;
  config.fine_tuning.steps = 1;
  const ClipStore store(std::move(clips));
  const TrainingSet data = make_training_set(store, config);
  on_every_device([&](Device& device) {
    const TrainedNetwork trained = train_network(device, data, store, config);
    REQUIRE(trained.early_stopping);
    CHECK(trained.early_stopping->held_out.size() == kClips);
  });
}

TEST_CASE("views of the person held out come as the actions weigh, and are not weighed again") {
  const TrainingFiles walks{
      {{1, 1, 30.0, 2.0}, {1, 2, 30.0, 2.0}, {2, 1, 30.0, 1.8}, {2, 2, 30.0, 1.0}}};
  std::vector<LoadedClip> clips = load_clips(walks.files());
  for (std::size_t i = 0; i < clips.size(); ++i)
    clips[i].clip.action = i % 2 == 0 ? "walk" : "stroll";
  TrainingConfig config = Scene::settings();
  config.hold_out_among = 2;
  config.fine_tuning.people_power = 0;
  const ClipStore store(std::move(clips));
  const FreshViewSource source(store, make_training_set(store, config), config);
  REQUIRE(source.held_out_views());
  const std::vector<double> weights =
      clip_weights(ClipSource(*source.held_out_views()).sequences(), 0);
  CHECK(std::ranges::count(weights, weights.front()) == static_cast<int>(weights.size()));
}

}  // namespace fresh_view_source_test
