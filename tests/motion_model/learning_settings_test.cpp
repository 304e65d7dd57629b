// The settings of the machines and of how they learn: defaults, presets, ranges, and the one list
// from which flags, files and records are made.

#include <doctest/doctest.h>

#include <limits>

#include "learning/contrastive_divergence.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/settings_table.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Setting>& learning_settings() {
  using C = TrainingConfig;
  static const std::vector<Setting> settings = {
      {"seed", [](C& c) { return at(c.seed); }, "1"},
      {"order", [](C& c) { return at(c.order); }, "10"},
      {"hidden", [](C& c) { return at(c.hidden); }, "768"},
      {"layers", [](C& c) { return at(c.layers); }, "1"},
      {"mrbm-hidden", [](C& c) { return at(c.mrbm_hidden); }, "512"},
      {"look-ahead", [](C& c) { return at(c.look_ahead); }, "5"},
      {"batch", [](C& c) { return at(c.batch); }, "100"},
      {"least-batches", [](C& c) { return at(c.least_batches); }, "40"},
      {"gaussian.gibbs-steps", [](C& c) { return at(c.gaussian.gibbs_steps); }, "5"},
      {"gaussian.rate", [](C& c) { return at(c.gaussian.rate); }, "0.001"},
      {"gaussian.rate-A", [](C& c) { return at(c.gaussian.rate_A); }, "1e-05"},
      {"gaussian.rate-B", [](C& c) { return at(c.gaussian.rate_B); }, "0.001"},
      {"gaussian.momentum", [](C& c) { return at(c.gaussian.momentum); }, "0.9"},
      {"gaussian.momentum-from-epoch", [](C& c) { return at(c.gaussian.momentum_from_epoch); },
       "5"},
      {"gaussian.weight-decay", [](C& c) { return at(c.gaussian.weight_decay); }, "0.0002"},
      {"gaussian.initial-deviation", [](C& c) { return at(c.gaussian.initial_deviation); }, "0.01"},
      {"gaussian.epochs", [](C& c) { return at(c.gaussian.epochs); }, "3"},
      {"binary.gibbs-steps", [](C& c) { return at(c.binary.gibbs_steps); }, "1"},
      {"binary.rate", [](C& c) { return at(c.binary.rate); }, "0.01"},
      {"binary.rate-A", [](C& c) { return at(c.binary.rate_A); }, "0.001"},
      {"binary.rate-B", [](C& c) { return at(c.binary.rate_B); }, "0.001"},
      {"binary.momentum", [](C& c) { return at(c.binary.momentum); }, "0.9"},
      {"binary.momentum-from-epoch", [](C& c) { return at(c.binary.momentum_from_epoch); }, "5"},
      {"binary.weight-decay", [](C& c) { return at(c.binary.weight_decay); }, "0.0002"},
      {"binary.initial-deviation", [](C& c) { return at(c.binary.initial_deviation); }, "0.01"},
      {"binary.epochs", [](C& c) { return at(c.binary.epochs); }, "3"},
      {"mrbm.rate", [](C& c) { return at(c.mrbm.rate); }, "0.0003"},
      {"mrbm.weight-decay", [](C& c) { return at(c.mrbm.weight_decay); }, "0"},
      {"mrbm.initial-deviation", [](C& c) { return at(c.mrbm.initial_deviation); }, "0.01"},
      {"mrbm.mean-field-steps", [](C& c) { return at(c.mrbm.mean_field_steps); }, "5"},
      {"mrbm.epochs", [](C& c) { return at(c.mrbm.epochs); }, "1"},
      {"fine-tuning.steps", [](C& c) { return at(c.fine_tuning.steps); }, "3000"},
      {"fine-tuning.from-greedy", [](C& c) { return at(c.fine_tuning.from_greedy); }, "true"},
      {"fine-tuning.windows", [](C& c) { return at(c.fine_tuning.windows); }, "48"},
      {"fine-tuning.window-frames", [](C& c) { return at(c.fine_tuning.window_frames); }, "20"},
      {"fine-tuning.settle-frames", [](C& c) { return at(c.fine_tuning.settle_frames); }, "4"},
      {"fine-tuning.rate", [](C& c) { return at(c.fine_tuning.rate); }, "0.002"},
      {"fine-tuning.weight-decay", [](C& c) { return at(c.fine_tuning.weight_decay); }, "1"},
      {"fine-tuning.dropout", [](C& c) { return at(c.fine_tuning.dropout); }, "0"},
      {"fine-tuning.average", [](C& c) { return at(c.fine_tuning.average); }, "0.995"},
      {"fine-tuning.reverse", [](C& c) { return at(c.fine_tuning.reverse); }, "0.1"},
      {"fine-tuning.mean-field-steps", [](C& c) { return at(c.fine_tuning.mean_field_steps); },
       "2"}};
  return settings;
}

}  // namespace

TEST_CASE("learning settings: every one has its default, its own name and its own member") {
  check_settings(learning_settings());
}

TEST_CASE("learning settings: the list leaves no member out") {
  CHECK(member_count<CdSettings>() == listed_under("gaussian."));
  CHECK(member_count<CdSettings>() == listed_under("binary."));
  CHECK(member_count<MultiPredictionSettings>() == listed_under("mrbm."));
  // Beside them three weights of the loss on poses, and how many people it takes to spare one.
  CHECK(member_count<FineTuningSettings>() + 4 == listed_under("fine-tuning."));
}

TEST_CASE(
    "learning settings: the greedy preset is two layers of the paper's size, trained longer") {
  CHECK(changed_by(TrainingConfig::greedy()) == Values{{"order", "5"},
                                                       {"hidden", "300"},
                                                       {"layers", "2"},
                                                       {"mrbm-hidden", "300"},
                                                       {"gaussian.epochs", "100"},
                                                       {"binary.epochs", "50"},
                                                       {"mrbm.rate", "0.001"},
                                                       {"mrbm.epochs", "30"},
                                                       {"fine-tuning.steps", "0"}});
}

TEST_CASE("learning settings: the paper's preset has the paper's own figures") {
  Values want = {{"order", "5"},
                 {"hidden", "300"},
                 {"layers", "2"},
                 {"mrbm-hidden", "150"},
                 {"look-ahead", "0"},
                 {"least-batches", "1"},
                 {"mrbm.rate", "0.1"},
                 {"mrbm.epochs", "30"},
                 {"mrbm.initial-deviation", "1"},
                 {"fine-tuning.steps", "0"},
                 {"binary.gibbs-steps", "5"}};
  for (const std::string kind : {"gaussian", "binary"}) {
    for (const std::string rate : {".rate", ".rate-A", ".rate-B"}) want[kind + rate] = "0.1";
    want[kind + ".momentum-from-epoch"] = "0";
    want[kind + ".weight-decay"] = "0";
    want[kind + ".initial-deviation"] = "1";
    want[kind + ".epochs"] = "100";
  }
  CHECK(changed_by(TrainingConfig::paper()) == want);
}

TEST_CASE("learning settings: the defaults and the presets are within range") {
  CHECK_NOTHROW(TrainingConfig{}.validate());
  CHECK_NOTHROW(TrainingConfig::greedy().validate());
  CHECK_NOTHROW(TrainingConfig::paper().validate());
}

TEST_CASE("learning settings: what is out of range is refused by its name") {
  const std::string positive = " must be above 0, not ";
  for (const char* name :
       {"hidden", "layers", "mrbm-hidden", "batch", "least-batches", "gaussian.gibbs-steps",
        "gaussian.rate", "gaussian.epochs", "binary.gibbs-steps", "binary.rate", "binary.epochs",
        "mrbm.rate", "mrbm.mean-field-steps", "mrbm.epochs", "fine-tuning.windows",
        "fine-tuning.rate", "fine-tuning.mean-field-steps"})
    check_refused(name, 0, positive + "0");
  for (const char* name : {"gaussian.rate", "binary.rate", "mrbm.rate", "fine-tuning.rate"}) {
    check_refused(name, -0.5, positive + "-0.5");
    check_refused(name, kNan, positive + "nan");
    check_accepted(name, 1e-9);
  }
  for (const char* name :
       {"gaussian.momentum", "binary.momentum", "fine-tuning.dropout", "fine-tuning.average"}) {
    const std::string share = " must be at least 0 and below 1, not ";
    check_refused(name, 1, share + "1");
    check_refused(name, -0.25, share + "-0.25");
    check_refused(name, kNan, share + "nan");
    check_accepted(name, 0);
    check_accepted(name, 0.999);
  }
  check_refused("fine-tuning.window-frames", 1, " must be at least 2");
  check_accepted("fine-tuning.window-frames", 2);
}

TEST_CASE("learning settings: what may be nothing is accepted as nothing") {
  for (const char* name :
       {"seed", "order", "look-ahead", "gaussian.rate-A", "gaussian.rate-B", "gaussian.momentum",
        "gaussian.momentum-from-epoch", "gaussian.weight-decay", "gaussian.initial-deviation",
        "binary.rate-A", "binary.weight-decay", "mrbm.weight-decay", "mrbm.initial-deviation",
        "fine-tuning.steps", "fine-tuning.from-greedy", "fine-tuning.settle-frames",
        "fine-tuning.weight-decay", "fine-tuning.reverse"})
    check_accepted(name, 0);
  for (const char* name : {"hidden", "layers", "mrbm-hidden", "batch", "least-batches",
                           "gaussian.gibbs-steps", "binary.epochs", "mrbm.mean-field-steps",
                           "mrbm.epochs", "fine-tuning.windows", "fine-tuning.mean-field-steps"})
    check_accepted(name, 1);
}

TEST_CASE("learning settings: what no setting says") {
  const UpdateRule adam = UpdateRule::adam();
  CHECK(adam.rate == 1e-3F);
  CHECK(adam.momentum == 0.9F);
  CHECK(adam.beta2 == 0.999F);
  CHECK(adam.epsilon == 1e-8F);
  CHECK(adam.weight_decay == 0);
  const UpdateRule momentum;
  CHECK(momentum.rate == 1e-3F);
  CHECK(momentum.momentum == 0);
  CHECK(momentum.weight_decay == 0);
  CHECK(CdRule{}.gibbs_steps == 1);
}
