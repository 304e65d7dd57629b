#include <doctest/doctest.h>

#include <limits>

#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/fine_tuning_case.hpp"

namespace fine_tuning_early_stopping_test {

using namespace mcdbn;
using namespace mcdbn::test;
using namespace mcdbn::reference;

namespace {

constexpr std::size_t kStranger = 1;

/// Three people, the second of whom is held out. The first two have two clips each.
FineTuningCase case_with_stranger() {
  FineTuningCase small({{30, 0}, {12, kStranger}, {11, 0}, {10, kStranger}, {4, 2}},
                       {{{{3, 2}}, {{4, 1}}}}, 5);
  small.config.hold_out_among = 3;
  small.config.fine_tuning.rate = 1e-3;
  return small;
}

/// The same where what is learnt from others first helps with the stranger and then harms: others
/// hold themselves much further to one side.
FineTuningCase case_with_other_stranger() {
  FineTuningCase small = case_with_stranger();
  for (std::size_t i = 0; i < small.views.poses.size(); ++i)
    small.views.poses[i].array() += small.views.people[i] == kStranger ? 0.65F : 2.0F;
  return small;
}

/// What the rule gives for the held-out losses that were seen, one every 25 mini-batches.
struct Kept {
  std::size_t steps = 0, reports = 0;
  double loss = 0;
};
Kept kept_of(const std::vector<double>& losses, std::size_t steps) {
  Kept kept;
  double best = std::numeric_limits<double>::infinity();
  for (const double loss : losses) {
    const std::size_t done = std::min(25 * ++kept.reports, steps);
    best = std::min(best, loss);
    if (loss <= 1.05 * best) {
      kept.steps = done;
      kept.loss = loss;
    } else if (done - kept.steps >= std::max<std::size_t>(100, steps / 4)) {
      break;
    }
  }
  return kept;
}

struct Watched {
  TrainedNetwork trained;
  std::vector<double> held_out;
};
Watched watch(const FineTuningCase& small, Device& device) {
  std::vector<double> held_out;
  TrainedNetwork trained = small.train(device, [&](const EpochReport& report) {
    REQUIRE(report.held_out_loss);
    held_out.push_back(*report.held_out_loss);
  });
  REQUIRE(trained.early_stopping);
  return {std::move(trained), held_out};
}

}  // namespace

TEST_CASE("the held-out loss is that of the averaged parameters on the stranger, nothing dropped") {
  FineTuningCase small = case_with_stranger();
  small.config.fine_tuning.steps = 30;
  small.config.fine_tuning.average = 0.9;
  FineTuning want = small.in_double_without(kStranger);
  std::vector<double> losses;
  for (std::size_t done = 1; done <= 30; ++done) {
    want.step();
    if (done == 25 || done == 30) losses.push_back(want.loss_on(small.data_of(kStranger)));
  }
  on_every_device([&](Device& device) {
    const auto [trained, held_out] = watch(small, device);
    REQUIRE(held_out.size() == 2);
    CHECK(held_out[0] == doctest::Approx(losses[0]).epsilon(1e-5));
    CHECK(held_out[1] == doctest::Approx(losses[1]).epsilon(1e-5));
    REQUIRE(held_out[1] < held_out[0]);
    CHECK(trained.early_stopping->steps == 30);
    CHECK(trained.early_stopping->loss == held_out[1]);
    CHECK(trained.early_stopping->held_out == std::vector<std::string>{"clip1.bvh", "clip3.bvh"});
    check_same_parameters(trained.network, want.averaged(), small.parameters);
  });
}

TEST_CASE("the parameters that are kept are those of the last mini-batch that did about as well") {
  FineTuningCase small = case_with_other_stranger();
  small.config.fine_tuning.steps = 480;
  FineTuning want = small.in_double_without(kStranger);
  for (std::size_t done = 0; done < 50; ++done) want.step();
  on_every_device([&](Device& device) {
    const auto [trained, held_out] = watch(small, device);
    // The second report is about as good as the first, the best; all after it are much worse.
    REQUIRE(held_out.size() > 3);
    REQUIRE(held_out[1] > 1.005 * held_out[0]);
    REQUIRE(held_out[1] < 1.045 * held_out[0]);
    for (std::size_t i = 2; i < held_out.size(); ++i) REQUIRE(held_out[i] > 1.1 * held_out[0]);
    CHECK(trained.early_stopping->steps == 50);
    CHECK(trained.early_stopping->loss == held_out[1]);
    CHECK(held_out.size() == 7);  // a quarter of all steps later: 120, so after 175
    check_same_parameters(trained.network, want.averaged(), small.parameters);
    CHECK(trained.network.mean_field_steps == small.config.fine_tuning.mean_field_steps);
    CHECK(trained.network.look_ahead == small.config.look_ahead);
  });
}

TEST_CASE("fine-tuning waits at least a hundred mini-batches for the stranger to fare better") {
  FineTuningCase small = case_with_other_stranger();
  small.config.fine_tuning.steps = 200;
  on_every_device([&](Device& device) {
    const auto [trained, held_out] = watch(small, device);
    const Kept want = kept_of(held_out, small.config.fine_tuning.steps);
    CHECK(want.steps == 50);
    CHECK(held_out.size() == 6);
    CHECK(want.reports == held_out.size());
    CHECK(trained.early_stopping->steps == want.steps);
    CHECK(trained.early_stopping->loss == want.loss);
  });
}

TEST_CASE("a stranger who fares better later is waited for") {
  // Wiggles: the rule alone decides which of many parameters are kept.
  FineTuningCase small = case_with_stranger();
  for (std::size_t i = 0; i < small.views.poses.size(); ++i)
    if (small.views.people[i] == kStranger) small.views.poses[i] *= 0.5F;
  small.config.fine_tuning.rate = 1e-2;
  small.config.fine_tuning.steps = 290;
  on_every_device([&](Device& device) {
    const auto [trained, held_out] = watch(small, device);
    const Kept want = kept_of(held_out, small.config.fine_tuning.steps);
    REQUIRE(std::is_sorted(held_out.rbegin(), held_out.rend()) == false);
    CHECK(want.reports == held_out.size());
    CHECK(trained.early_stopping->steps == want.steps);
    CHECK(trained.early_stopping->loss == want.loss);
  });
}

TEST_CASE("no person is held out of fewer than was asked for") {
  FineTuningCase small = case_with_stranger();
  small.config.fine_tuning.steps = 2;
  small.config.hold_out_among = 4;
  FineTuning want = small.in_double_without(FineTuningCase::kNobody);
  want.step();
  want.step();
  on_every_device([&](Device& device) {
    const TrainedNetwork trained = small.train(device);
    CHECK_FALSE(trained.early_stopping);
    check_same_parameters(trained.network, want.averaged(), small.parameters);
  });
}

}  // namespace fine_tuning_early_stopping_test
