#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/scratch_folder.hpp"
#include "corpus/augmented_views.hpp"
#include "corpus/held_out_person.hpp"
#include "device/every_device.hpp"
#include "learning/random_start.hpp"
#include "learning/unrolled_pass.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion_model/fine_tuning_on_views.hpp"

namespace fine_tuning_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Two synthesized walks of each person as files, and a configuration small enough for a test.
class SmallRun {
 public:
  explicit SmallRun(int people = 1) {
    for (int person = 0; person < people; ++person)
      for (int clip = 0; clip < 2; ++clip) {
        files.push_back(folder / fmt::format("walk_{}_{}.bvh", person, clip));
        write_bvh(files.back(), synthesize_clip(person, clip));
      }
    config.hidden = 10;
    config.mrbm_hidden = 8;
    config.order = 2;
    config.layers = 2;
    config.look_ahead = 2;
    config.augment.views = 2;
    config.fine_tuning.steps = 40;
    config.fine_tuning.windows = 8;
    config.fine_tuning.window_frames = 8;
    data = std::make_unique<TrainingSet>(make_training_set(load_clips(files), config));
  }

  Mcdbn start(Device& device) const {
    return random_start(
        device,
        {{"track", static_cast<std::size_t>(data->tracks.front().cols()), VisibleKind::gaussian},
         {"pose", static_cast<std::size_t>(data->poses.front().cols()), VisibleKind::gaussian}},
        config);
  }

  ScratchFolder folder;
  std::vector<std::filesystem::path> files;
  TrainingConfig config;
  std::unique_ptr<TrainingSet> data;

 private:
  static Motion synthesize_clip(int person, int clip) {
    SynthesisOptions options;
    options.seconds = 2.0;
    options.seed = 7;
    options.subject = person + 1;
    options.clip = clip + 1;
    return synthesize(options);
  }
};

bool same_bits(const Mcdbn& x, const Mcdbn& y) {
  bool same = x.mrbm.W[0].to_host() == y.mrbm.W[0].to_host();
  for (std::size_t i = 0; i < x.cdbns[1].layers.size(); ++i)
    same = same && x.cdbns[1].layers[i].A.to_host() == y.cdbns[1].layers[i].A.to_host() &&
           x.cdbns[0].layers[i].B.to_host() == y.cdbns[0].layers[i].B.to_host();
  return same;
}

}  // namespace

TEST_CASE("fine-tuning lowers its loss, and the same seed gives the same bits") {
  const SmallRun run;
  const TrainingSet views =
      make_augmented_views(load_clips(run.files), run.data->modalities, run.config);
  REQUIRE(views.poses.size() == 4);
  CHECK((views.poses[0].rows() != views.poses[1].rows() || views.poses[0] != views.poses[1]));
  on_every_device([&](Device& device) {
    std::vector<double> losses;
    const auto observer = [&](const EpochReport& report) {
      CHECK(report.stage == "fine-tuning");
      losses.push_back(report.loss);
    };
    const Mcdbn start = run.start(device);
    const Mcdbn once = fine_tune_on_views(device, start, views, run.config, observer).network;
    REQUIRE(losses.size() == 2);
    CHECK(losses[1] < losses[0]);
    CHECK(once.mean_field_steps == run.config.fine_tuning.mean_field_steps);
    CHECK(once.look_ahead == run.config.look_ahead);
    CHECK(same_bits(once, fine_tune_on_views(device, start, views, run.config).network));
    TrainingConfig other = run.config;
    other.seed = 2;
    CHECK_FALSE(same_bits(once, fine_tune_on_views(device, start, views, other).network));
  });
}

TEST_CASE("one of several people is held out, and nothing is learnt from them") {
  SmallRun run(4);
  run.config.fine_tuning.steps = 75;
  run.config.hold_out_among = 4;
  const TrainingSet views =
      make_augmented_views(load_clips(run.files), run.data->modalities, run.config);
  const auto person = person_to_hold_out(views, 4);
  REQUIRE(person);
  const TrainingSet others = views_without(views, *person);
  CHECK(others.poses.size() == 12);
  CHECK(views_of(views, *person).poses.size() == 4);
  on_every_device([&](Device& device) {
    std::vector<double> losses;
    const auto observer = [&](const EpochReport& report) {
      REQUIRE(report.held_out_loss);
      losses.push_back(*report.held_out_loss);
    };
    const Mcdbn start = run.start(device);
    const TrainedNetwork trained = fine_tune_on_views(device, start, views, run.config, observer);
    REQUIRE(trained.early_stopping);
    REQUIRE(losses.size() == 3);
    CHECK(trained.early_stopping->loss == losses.back());
    CHECK(trained.early_stopping->steps == 75);
    CHECK(trained.early_stopping->held_out == clip_names(views_of(views, *person)));
    // So small a run gets better to its end, which is then what it is without that person.
    REQUIRE(losses[2] < losses[1]);
    CHECK(
        same_bits(trained.network, fine_tune_on_views(device, start, others, run.config).network));

    TrainingConfig everybody = run.config;
    everybody.hold_out_among = 5;
    CHECK_FALSE(fine_tune_on_views(device, start, views, everybody).early_stopping);
  });
}

TEST_CASE("parameters of before the person held out fared worse are kept") {
  SmallRun run(4);
  run.config.fine_tuning.steps = 200;
  run.config.hold_out_among = 4;
  TrainingSet views = make_augmented_views(load_clips(run.files), run.data->modalities, run.config);
  // Somebody who does the opposite: the more is learnt from others, the worse.
  const auto person = person_to_hold_out(views, 4);
  for (std::size_t i = 0; i < views.poses.size(); ++i)
    if (views.people[i] == person) views.poses[i] *= -1.0F;
  on_every_device([&](Device& device) {
    std::size_t reports = 0;
    const TrainedNetwork trained = fine_tune_on_views(device, run.start(device), views, run.config,
                                                      [&](const EpochReport&) { ++reports; });
    REQUIRE(trained.early_stopping);
    CHECK(trained.early_stopping->steps < 25 * reports);
    CHECK(25 * reports < run.config.fine_tuning.steps);
  });
}

TEST_CASE("an observer stops fine-tuning, and windows need their histories") {
  const SmallRun run;
  const TrainingSet views =
      make_augmented_views(load_clips(run.files), run.data->modalities, run.config);
  on_every_device([&](Device& device) {
    const Mcdbn start = run.start(device);
    const auto stop = [](const EpochReport&) { throw InputError("enough"); };
    CHECK_THROWS_AS(fine_tune_on_views(device, start, views, run.config, stop), InputError);
    UnrolledNetwork network(device, start, run.config.fine_tuning.mean_field_steps);
    CHECK_THROWS_AS(UnrolledPass(network, 1, {4, 10, 3, 5}), ShapeError);
    CHECK_THROWS_AS(UnrolledPass(network, 1, {4, 10, 4, 10}), ShapeError);
  });
}

TEST_CASE("greedy stages before fine-tuning go on from its own starting weights") {
  SmallRun run;
  run.config.gaussian.rate = run.config.gaussian.rate_A = run.config.gaussian.rate_B = 1e-9;
  run.config.binary = run.config.gaussian;
  run.config.mrbm.rate = 1e-9;
  const TrainingSet views =
      make_augmented_views(load_clips(run.files), run.data->modalities, run.config);
  on_every_device([&](Device& device) {
    const Mcdbn start = run.start(device);
    const Mcdbn still = train_greedy(device, ClipSource(views), run.config, {}, &start);
    const auto difference = [](const Matrix& a, const Matrix& b) {
      return (a.to_host() - b.to_host()).cwiseAbs().maxCoeff();
    };
    for (const std::size_t modality : {0, 1}) {
      for (std::size_t i = 0; i < run.config.layers; ++i) {
        const Crbm &from = start.cdbns[modality].layers[i], &to = still.cdbns[modality].layers[i];
        CHECK(difference(from.W, to.W) < 1e-5);
        CHECK(difference(from.B, to.B) < 1e-5);
        CHECK(difference(from.a, to.a) < 1e-5);
      }
    }
    CHECK(difference(start.mrbm.W[0], still.mrbm.W[0]) < 1e-5);
    CHECK(difference(start.mrbm.a[1], still.mrbm.a[1]) < 1e-5);
    const Mcdbn alone = train_greedy(device, ClipSource(views), run.config);
    CHECK(difference(start.cdbns[1].layers[0].W, alone.cdbns[1].layers[0].W) > 0.1);
  });
}

}  // namespace fine_tuning_test
