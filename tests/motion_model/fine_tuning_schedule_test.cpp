#include <doctest/doctest.h>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/fine_tuning_case.hpp"

namespace fine_tuning_schedule_test {

using namespace mcdbn;
using namespace mcdbn::test;
using namespace mcdbn::reference;

namespace {

/// Clips of three people, one of them shorter than a window's judged frames.
const std::vector<SmallClip> kClips{{30, 0}, {11, 1}, {21, 0}, {4, 2}};

/// What a whole run does in double precision.
struct Run {
  std::vector<double> losses;  ///< of every mini-batch
  double longest_gradient = 0, shortest_gradient = 1e30;
  UnrolledModel averaged;
};

Run run_in_double(const FineTuningCase& small) {
  Run run;
  FineTuning fine_tuning = small.in_double_without(FineTuningCase::kNobody);
  for (std::size_t i = 0; i < small.config.fine_tuning.steps; ++i) {
    run.losses.push_back(fine_tuning.step());
    run.longest_gradient = std::max(run.longest_gradient, fine_tuning.gradient_length());
    run.shortest_gradient = std::min(run.shortest_gradient, fine_tuning.gradient_length());
  }
  run.averaged = fine_tuning.averaged();
  return run;
}

double mean(const std::vector<double>& all, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += all[i];
  return sum / static_cast<double>(to - from);
}

/// Reports come after every 25 mini-batches and after the last.
void check_reports(const std::vector<EpochReport>& reports, const Run& run) {
  const std::size_t steps = run.losses.size();
  std::size_t before = 0;
  for (const EpochReport& report : reports) {
    const std::size_t done = std::min(before + 25, steps);
    CHECK(report.stage == "fine-tuning");
    CHECK(report.epoch == done);
    CHECK(report.epochs == steps);
    CHECK(report.stage_progress ==
          doctest::Approx(static_cast<double>(done) / static_cast<double>(steps)));
    CHECK(report.overall_progress == report.stage_progress);
    CHECK(report.loss == doctest::Approx(mean(run.losses, before, done)).epsilon(1e-5));
    CHECK(report.windows_per_s > 0);
    CHECK_FALSE(report.held_out_loss);
    before = done;
  }
  CHECK(before == steps);
}

void check_run(const FineTuningCase& small, const Run& want) {
  on_every_device([&](Device& device) {
    std::vector<EpochReport> reports;
    const TrainedNetwork trained =
        small.train(device, [&](const EpochReport& report) { reports.push_back(report); });
    check_same_parameters(trained.network, want.averaged, small.parameters);
    check_reports(reports, want);
    CHECK_FALSE(trained.early_stopping);
    CHECK(trained.network.mean_field_steps == small.config.fine_tuning.mean_field_steps);
    CHECK(trained.network.look_ahead == small.config.look_ahead);
    CHECK_FALSE(trained.network.fills_gaps);
  });
}

}  // namespace

TEST_CASE("the foot of the small figure stands in some frames and moves in others") {
  const FineTuningCase small(kClips, {{{{2, 1}}, {{2, 1}}}}, 2);
  for (const std::size_t clip : {0, 2}) {
    const MatrixD poses = small.views.poses[clip].cast<double>();
    const Eigen::Index standing = small.judge().planted_steps(poses);
    CHECK(4 * standing > poses.rows());
    CHECK(4 * standing < 3 * poses.rows());
  }
}

TEST_CASE("fine-tuning is the reference's schedule: two layers of equal sizes, gradients cut") {
  FineTuningCase small(kClips, {{{{4, 2}, {4, 2}}, {{4, 2}, {4, 2}}}}, 4);
  small.config.fine_tuning.steps = 10;
  const Run want = run_in_double(small);
  REQUIRE(want.longest_gradient > 1.2);
  REQUIRE(want.shortest_gradient < 0.8);
  check_run(small, want);
}

TEST_CASE("fine-tuning is the reference's schedule: past the rate's rise, two reports") {
  FineTuningCase small(kClips, {{{{5, 2, 1, 2}, {3, 1}}, {{4, 1}, {6, 3, 3, 2}}}}, 7);
  small.config.fine_tuning.steps = 36;
  small.config.fine_tuning.average = 0.7;
  small.config.look_ahead = 3;
  check_run(small, run_in_double(small));
}

TEST_CASE("fine-tuning is the reference's schedule: nothing dropped, decayed, averaged, reversed") {
  FineTuningCase small(kClips, {{{{3, 1}}, {{4, 3}}}}, 5);
  small.views.people.clear();
  small.config.look_ahead = 0;
  mcdbn::FineTuningSettings& settings = small.config.fine_tuning;
  settings.steps = 5;
  settings.dropout = settings.weight_decay = settings.average = settings.reverse = 0;
  settings.settle_frames = 0;
  settings.mean_field_steps = 1;
  check_run(small, run_in_double(small));
  on_every_device([&](Device& device) {
    // Without the other direction nothing is learnt by what it alone has.
    const TrainedNetwork trained = small.train(device);
    CHECK(trained.network.cdbns[1].layers[0].B.to_host() ==
          small.start(device).cdbns[1].layers[0].B.to_host());
    CHECK(trained.network.cdbns[0].layers[0].A.to_host() ==
          small.start(device).cdbns[0].layers[0].A.to_host());
  });
}

TEST_CASE("each part of the loss and each direction weighs as its setting specifies") {
  FineTuningCase small(kClips, {{{{3, 1}}, {{4, 1}}}}, 5);
  small.config.fine_tuning.steps = 2;
  const auto check = [&](const std::function<void(TrainingConfig&)>& change) {
    FineTuningCase other = small;
    change(other.config);
    check_run(other, run_in_double(other));
  };
  check([](TrainingConfig& config) { config.pose_loss.positions = 0.3; });
  check([](TrainingConfig& config) { config.pose_loss.velocities = 0.1; });
  check([](TrainingConfig& config) { config.pose_loss.contacts = 0.1; });
  check([](TrainingConfig& config) { config.fine_tuning.reverse = 1.1; });
}

TEST_CASE("fine-tuning that diverges is stopped, and the message names what to lower") {
  FineTuningCase small(kClips, {{{{3, 1}}, {{4, 1}}}}, 5);
  small.config.fine_tuning.steps = 100;
  small.config.fine_tuning.rate = 20;
  on_every_device([&](Device& device) {
    CHECK_THROWS_AS(small.train(device), DivergenceError);
    CHECK_THROWS_WITH(small.train(device), doctest::Contains("`fine-tuning.rate` (now 20)"));
  });
}

}  // namespace fine_tuning_schedule_test
