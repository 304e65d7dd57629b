#include "mcdbn/motion_model/training_schedule.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "corpus/augmented_views.hpp"
#include "corpus/held_out_person.hpp"
#include "corpus/training_files.hpp"
#include "learning/learnt_deviation.hpp"
#include "learning/random_start.hpp"
#include "learning/small_network.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "motion_model/fine_tuning_on_views.hpp"
#include "motion_model/pose_loss.hpp"
#include "motion_model/tiny_training_config.hpp"

namespace training_schedule_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Files, settings and the training set of a run that takes a second.
struct SmallTraining {
  TrainingFiles walks{{{1, 1, 30.0, 1.2}, {2, 1, 30.0, 1.0}}};
  TrainingConfig config = tiny_training_config();
  TrainingSet data = make_training_set(load_clips(walks.files()), config);

  TrainedNetwork train(Device& device, const TrainingConfig& with,
                       const EpochObserver& observer = {}) const {
    return train_network(device, data, load_clips(walks.files()), with, observer);
  }
  TrainingSet views(const TrainingConfig& with) const {
    return make_augmented_views(load_clips(walks.files()), data.modalities, with);
  }
  Mcdbn start(Device& device, const TrainingConfig& with) const {
    return random_start(
        device,
        {{"track", static_cast<std::size_t>(data.tracks.front().cols()), VisibleKind::gaussian},
         {"pose", static_cast<std::size_t>(data.poses.front().cols()), VisibleKind::gaussian}},
        with);
  }
};

/// All parameters of two networks are the same bits, at the same steps and look-ahead.
bool same_network(const Mcdbn& x, const Mcdbn& y) {
  const auto flat = [](const Mcdbn& network) { return in_double(on_host(network)).flattened(); };
  return flat(x) == flat(y) && x.look_ahead == y.look_ahead &&
         x.mean_field_steps == y.mean_field_steps && x.fills_gaps == y.fills_gaps;
}

std::vector<std::string> stages_of(const std::vector<EpochReport>& reports) {
  std::vector<std::string> stages;
  for (const EpochReport& report : reports)
    if (stages.empty() || stages.back() != report.stage) stages.push_back(report.stage);
  return stages;
}

const EpochReport& last_of(const std::vector<EpochReport>& reports, const std::string& stage) {
  return *std::find_if(reports.rbegin(), reports.rend(),
                       [&](const EpochReport& report) { return report.stage == stage; });
}

void check_progress_rises(const std::vector<EpochReport>& reports) {
  double before = 0;
  for (const EpochReport& report : reports) {
    CHECK(report.overall_progress > before);
    before = report.overall_progress;
  }
  CHECK(before == doctest::Approx(1.0));
}

}  // namespace

TEST_CASE("without fine-tuning the greedy stages learn the clips as they are") {
  const SmallTraining small;
  TrainingConfig config = small.config;
  config.fine_tuning.steps = 0;
  on_every_device([&](Device& device) {
    std::vector<EpochReport> reports;
    const TrainedNetwork trained =
        small.train(device, config, [&](const EpochReport& report) { reports.push_back(report); });
    CHECK(same_network(trained.network, train_greedy(device, ClipSource(small.data), config)));
    CHECK(trained.network.fills_gaps);
    CHECK(trained.network.mean_field_steps == 4);
    CHECK_FALSE(trained.early_stopping);
    CHECK(stages_of(reports) == std::vector<std::string>{"pose.0", "track.0", "mrbm"});
    check_progress_rises(reports);
  });
}

TEST_CASE("fine-tuning goes on from what the greedy stages made of its start and the same views") {
  const SmallTraining small;
  on_every_device([&](Device& device) {
    std::vector<EpochReport> reports;
    const TrainedNetwork trained = small.train(
        device, small.config, [&](const EpochReport& report) { reports.push_back(report); });
    const TrainingSet views = small.views(small.config);
    const Mcdbn start = small.start(device, small.config);
    const Mcdbn greedy = train_greedy(device, ClipSource(views), small.config, {}, &start);
    CHECK(same_network(trained.network,
                       fine_tune_on_views(device, greedy, views, small.config).network));
    CHECK_FALSE(trained.network.fills_gaps);
    CHECK(trained.network.mean_field_steps == 2);
    CHECK(stages_of(reports) ==
          std::vector<std::string>{"pose.0", "track.0", "mrbm", "fine-tuning"});
    check_progress_rises(reports);
    CHECK(last_of(reports, "mrbm").overall_progress == doctest::Approx(0.1));
    CHECK(last_of(reports, "mrbm").stage_progress == doctest::Approx(1.0));

    TrainingConfig alone = small.config;
    alone.fine_tuning.from_greedy = false;
    reports.clear();
    const TrainedNetwork without =
        small.train(device, alone, [&](const EpochReport& report) { reports.push_back(report); });
    CHECK(same_network(without.network, fine_tune_on_views(device, start, views, alone).network));
    CHECK_FALSE(same_network(without.network, trained.network));
    CHECK(stages_of(reports) == std::vector<std::string>{"fine-tuning"});
    check_progress_rises(reports);
  });
}

TEST_CASE(
    "a deviation that is to be learnt where limbs are hidden is refused before the training") {
  const SmallTraining small;
  TrainingConfig config = small.config;
  config.order = 0;
  config.gaussian.deviation_rate = 0.05;
  const auto refusal = [&](Device& device, const TrainingConfig& with) -> std::string {
    bool has_begun = false;
    try {
      small.train(device, with, [&](const EpochReport&) { has_begun = true; });
    } catch (const ConfigError& error) {
      CHECK_FALSE(has_begun);
      return error.what();
    }
    CHECK(has_begun);
    return "";
  };
  on_every_device([&](Device& device) {
    for (const double missing : {0.3, 0.0}) {
      config.augment.missing = missing;
      config.augment.detector = 0.3 - missing;
      const std::string text = refusal(device, config);
      for (const char* name :
           {"`gaussian.deviation-rate` (now 0.05)", "augment.missing", "augment.detector"})
        CHECK(text.find(name) != std::string::npos);
    }
    config.augment.detector = 0;
    CHECK(refusal(device, config).empty());
    // Nor is there anything to refuse where no deviation is learnt.
    config.augment.missing = 0.3;
    TrainingConfig alone = config;
    alone.fine_tuning.from_greedy = false;
    CHECK(refusal(device, alone).empty());
    TrainingConfig with_history = config;
    with_history.order = 2;
    CHECK(refusal(device, with_history).empty());
  });
}

TEST_CASE("fresh views on the way are others and the same in every run") {
  SmallTraining small;
  on_every_device([&](Device& device) {
    const auto trained = [&](std::size_t view_uses) {
      small.config.fine_tuning.view_uses = view_uses;
      return small.train(device, small.config, {}).network;
    };
    const Mcdbn never = trained(0), often = trained(2), seldom = trained(1000);
    CHECK_FALSE(same_network(often, never));
    CHECK_FALSE(same_network(often, seldom));
    CHECK(same_network(trained(2), often));
    REQUIRE(often.deviation);
    CHECK((often.deviation->of(MatrixF::Zero(1, often.deviation->C.rows())).array() > 0).all());
  });
}

TEST_CASE("what fresh views teach, stage by stage") {
  SmallTraining small;
  small.config.fine_tuning.view_uses = 3;
  small.config.hold_out_among = 2;
  const ClipStore clips = load_clips(small.walks.files());
  on_every_device([&](Device& device) {
    std::vector<EpochReport> reports;
    const TrainedNetwork trained = small.train(
        device, small.config, [&](const EpochReport& report) { reports.push_back(report); });
    const FreshViewSource views(clips, small.data, small.config);
    const Mcdbn start = small.start(device, small.config);
    const Mcdbn greedy = train_greedy(device, views, small.config, {}, &start);
    const ClipSource held_out_source(*views.held_out_views());
    const FineTuned tuned =
        fine_tune(device, greedy, views, &held_out_source, small.config,
                  [&](Device& where, const SequenceWindows& w) {
                    return std::make_unique<PoseLoss>(where, small.data.modalities, w,
                                                      small.config.pose_loss);
                  });
    CHECK(same_network(trained.network, tuned.network));
    REQUIRE(trained.early_stopping);
    CHECK(trained.early_stopping->held_out == std::vector<std::string>{"walk_2_1.bvh"});
    REQUIRE(reports.back().waiting_share);
    CHECK(*reports.back().waiting_share >= 0);
    CHECK(*reports.back().waiting_share <= 1);
    // How sure it is it learns from views that it did not learn from.
    REQUIRE(trained.network.deviation);
    views.renew(small.config.fine_tuning.steps + views.lifetime());
    const SynchronizedClips unseen = held_out_source.sequences();
    CHECK(trained.network.deviation->C ==
          learnt_deviation(tuned.network, views.sequences(), &unseen).C);
    CHECK(trained.network.deviation->c ==
          learnt_deviation(tuned.network, views.sequences(), &unseen).c);
  });
}

TEST_CASE("fine-tuning's progress runs on from that of the greedy stages") {
  SmallTraining small;
  small.config.fine_tuning.steps = 50;
  on_every_device([&](Device& device) {
    for (const bool from_greedy : {true, false}) {
      TrainingConfig config = small.config;
      config.fine_tuning.from_greedy = from_greedy;
      std::vector<double> progress;
      small.train(device, config, [&](const EpochReport& report) {
        if (report.stage == "fine-tuning") progress.push_back(report.overall_progress);
      });
      REQUIRE(progress.size() == 2);
      CHECK(progress[0] == doctest::Approx(from_greedy ? 0.1 + 0.9 * 0.5 : 0.5));
      CHECK(progress[1] == doctest::Approx(1.0));
    }
  });
}

TEST_CASE("one person of several is held out by the whole run too, and the observer may stop it") {
  SmallTraining small;
  small.config.hold_out_among = 2;
  on_every_device([&](Device& device) {
    const TrainedNetwork trained = small.train(device, small.config);
    REQUIRE(trained.early_stopping);
    CHECK(trained.early_stopping->held_out == std::vector<std::string>{"walk_2_1.bvh"});
    const auto stop_at = [&](const std::string& stage) {
      return [stage](const EpochReport& report) {
        if (report.stage == stage) throw InputError("enough of " + report.stage);
      };
    };
    CHECK_THROWS_WITH(small.train(device, small.config, stop_at("mrbm")), "enough of mrbm");
    CHECK_THROWS_WITH(small.train(device, small.config, stop_at("fine-tuning")),
                      "enough of fine-tuning");
  });
}

TEST_CASE("the person held out has no part in the greedy start either") {
  SmallTraining small;
  small.config.hold_out_among = 2;
  const TrainingSet views = small.views(small.config);
  const auto person = person_to_hold_out(views, 2);
  REQUIRE(person);
  const TrainingSet others = views_without(views, *person);
  on_every_device([&](Device& device) {
    const TrainedNetwork trained = small.train(device, small.config);
    const Mcdbn start = small.start(device, small.config);
    const auto from = [&](const TrainingSet& greedy_views) {
      const Mcdbn greedy = train_greedy(device, ClipSource(greedy_views), small.config, {}, &start);
      return fine_tune_on_views(device, greedy, views, small.config).network;
    };
    CHECK(same_network(trained.network, from(others)));
    CHECK_FALSE(same_network(trained.network, from(views)));
  });
}

TEST_CASE("a run's seed reaches its views, its start, its greedy stages and its fine-tuning") {
  const SmallTraining small;
  TrainingConfig other = small.config;
  other.seed = 20;
  on_every_device([&](Device& device) {
    const TrainedNetwork trained = small.train(device, other);
    const TrainingSet views = small.views(other), old_views = small.views(small.config);
    const Mcdbn start = small.start(device, other), old_start = small.start(device, small.config);
    const auto from = [&](const TrainingSet& greedy_views, const Mcdbn& greedy_start,
                          const TrainingConfig& greedy_config, const TrainingSet& tuned_views,
                          const TrainingConfig& tuned_config) {
      const Mcdbn greedy =
          train_greedy(device, ClipSource(greedy_views), greedy_config, {}, &greedy_start);
      return fine_tune_on_views(device, greedy, tuned_views, tuned_config).network;
    };
    CHECK(same_network(trained.network, from(views, start, other, views, other)));
    // Were any of them the old seed's, the result would be another.
    CHECK_FALSE(same_network(trained.network, from(old_views, start, other, views, other)));
    CHECK_FALSE(same_network(trained.network, from(views, old_start, other, views, other)));
    CHECK_FALSE(same_network(trained.network, from(views, start, small.config, views, other)));
    CHECK_FALSE(same_network(trained.network, from(views, start, other, old_views, other)));
    CHECK_FALSE(same_network(trained.network, from(views, start, other, views, small.config)));
  });
}

}  // namespace training_schedule_test
