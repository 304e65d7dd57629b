// Views that give way to fresh ones on the way: what a mini-batch is drawn from hangs on its
// number.
#include <doctest/doctest.h>

#include "corpus/training_files.hpp"
#include "learning/small_network.hpp"
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
  CHECK(count == 8);                        // four of each clip, which is one piece
  CHECK(steps.sequences().groups.empty());  // they are drawn as people and actions weigh already
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

TEST_CASE("fresh views are learnt from where they are asked for") {
  const Scene scene;
  TrainingConfig config = scene.config;
  CHECK(learns_from_fresh_views(scene.clips, config));
  config.fine_tuning.view_uses = 0;
  CHECK_FALSE(learns_from_fresh_views(scene.clips, config));
  // More than can be kept.
  std::vector<ClipRecord> many(70, {{}, {}, {}, {}, 1.0 / 30, 3000});
  CHECK(learns_from_fresh_views(ClipStore(many, nullptr), config));
  CHECK(fresh_views_at_once(ClipStore(many, nullptr), config) == 400);
  config.fine_tuning.steps = 0;
  CHECK_FALSE(learns_from_fresh_views(ClipStore(many, nullptr), config));
}

TEST_CASE("of several people one is held out of them, and judges by the same views always") {
  const Scene scene;
  TrainingConfig config = scene.config;
  CHECK_FALSE(FreshViewSource(scene.clips, scene.data, config).strangers());
  config.hold_out_among = 2;
  const FreshViewSource source(scene.clips, scene.data, config),
      again(scene.clips, scene.data, config);
  REQUIRE(source.strangers());
  const TrainingSet& strangers = *source.strangers();
  for (const TrainingClip& clip : strangers.clips)
    CHECK(clip.path == scene.clips.record(1).clip.path);  // the person with the least data
  REQUIRE(strangers.poses.size() == again.strangers()->poses.size());
  CHECK(strangers.poses[3] == again.strangers()->poses[3]);
  CHECK(strangers.tracks[3] == again.strangers()->tracks[3]);
}

}  // namespace fresh_view_source_test
