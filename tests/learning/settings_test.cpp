// The settings of networks and of how they learn: defaults, presets, ranges.

#include <doctest/doctest.h>

#include <cmath>

#include "base/settings_table.hpp"
#include "learning/contrastive_divergence.hpp"
#include "mcdbn/learning/learning_settings.hpp"

namespace settings_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const std::vector<Expected<LearningSettings>>& learning_settings() {
  using C = LearningSettings;
  static const std::vector<Expected<C>> settings = {
      {"seed", [](C& c) { return at(c.seed); }, "1"},
      {"order", [](C& c) { return at(c.order); }, "10"},
      {"hidden", [](C& c) { return at(c.hidden); }, "768"},
      {"layers", [](C& c) { return at(c.layers); }, "1"},
      {"mrbm-hidden", [](C& c) { return at(c.mrbm_hidden); }, "512"},
      {"look-ahead", [](C& c) { return at(c.look_ahead); }, "5"},
      {"batch", [](C& c) { return at(c.batch); }, "100"},
      {"least-batches", [](C& c) { return at(c.least_batches); }, "40"},
      {"people-power", [](C& c) { return at(c.people_power); }, "1"},
      {"gaussian.gibbs-steps", [](C& c) { return at(c.gaussian.gibbs_steps); }, "5"},
      {"gaussian.rate", [](C& c) { return at(c.gaussian.rate); }, "0.001"},
      {"gaussian.rate-A", [](C& c) { return at(c.gaussian.rate_A); }, "1e-05"},
      {"gaussian.rate-B", [](C& c) { return at(c.gaussian.rate_B); }, "0.001"},
      {"gaussian.momentum", [](C& c) { return at(c.gaussian.momentum); }, "0.9"},
      {"gaussian.momentum-from-epoch", [](C& c) { return at(c.gaussian.momentum_from_epoch); },
       "5"},
      {"gaussian.weight-decay", [](C& c) { return at(c.gaussian.weight_decay); }, "0.0002"},
      {"gaussian.initial-deviation", [](C& c) { return at(c.gaussian.initial_deviation); }, "0.01"},
      {"gaussian.history-noise", [](C& c) { return at(c.gaussian.history_noise); }, "0"},
      {"gaussian.epochs", [](C& c) { return at(c.gaussian.epochs); }, "3"},
      {"gaussian.persistent", [](C& c) { return at(c.gaussian.persistent); }, "false"},
      {"gaussian.fast-rate", [](C& c) { return at(c.gaussian.fast_rate); }, "0"},
      {"gaussian.sample-visible", [](C& c) { return at(c.gaussian.sample_visible); }, "false"},
      {"gaussian.sparsity-target", [](C& c) { return at(c.gaussian.sparsity_target); }, "0.1"},
      {"gaussian.sparsity-strength", [](C& c) { return at(c.gaussian.sparsity_strength); }, "0"},
      {"gaussian.l1", [](C& c) { return at(c.gaussian.l1); }, "0"},
      {"gaussian.adam", [](C& c) { return at(c.gaussian.adam); }, "false"},
      {"gaussian.final-rate", [](C& c) { return at(c.gaussian.final_rate); }, "1"},
      {"gaussian.cosine", [](C& c) { return at(c.gaussian.cosine); }, "false"},
      {"gaussian.deviation-rate", [](C& c) { return at(c.gaussian.deviation_rate); }, "0"},
      {"binary.gibbs-steps", [](C& c) { return at(c.binary.gibbs_steps); }, "1"},
      {"binary.rate", [](C& c) { return at(c.binary.rate); }, "0.01"},
      {"binary.rate-A", [](C& c) { return at(c.binary.rate_A); }, "0.001"},
      {"binary.rate-B", [](C& c) { return at(c.binary.rate_B); }, "0.001"},
      {"binary.momentum", [](C& c) { return at(c.binary.momentum); }, "0.9"},
      {"binary.momentum-from-epoch", [](C& c) { return at(c.binary.momentum_from_epoch); }, "5"},
      {"binary.weight-decay", [](C& c) { return at(c.binary.weight_decay); }, "0.0002"},
      {"binary.initial-deviation", [](C& c) { return at(c.binary.initial_deviation); }, "0.01"},
      {"binary.history-noise", [](C& c) { return at(c.binary.history_noise); }, "0"},
      {"binary.epochs", [](C& c) { return at(c.binary.epochs); }, "3"},
      {"binary.persistent", [](C& c) { return at(c.binary.persistent); }, "false"},
      {"binary.fast-rate", [](C& c) { return at(c.binary.fast_rate); }, "0"},
      {"binary.sample-visible", [](C& c) { return at(c.binary.sample_visible); }, "false"},
      {"binary.sparsity-target", [](C& c) { return at(c.binary.sparsity_target); }, "0.1"},
      {"binary.sparsity-strength", [](C& c) { return at(c.binary.sparsity_strength); }, "0"},
      {"binary.l1", [](C& c) { return at(c.binary.l1); }, "0"},
      {"binary.adam", [](C& c) { return at(c.binary.adam); }, "false"},
      {"binary.final-rate", [](C& c) { return at(c.binary.final_rate); }, "1"},
      {"binary.cosine", [](C& c) { return at(c.binary.cosine); }, "false"},
      {"binary.deviation-rate", [](C& c) { return at(c.binary.deviation_rate); }, "0"},
      {"mrbm.rate", [](C& c) { return at(c.mrbm.rate); }, "0.0003"},
      {"mrbm.weight-decay", [](C& c) { return at(c.mrbm.weight_decay); }, "0"},
      {"mrbm.initial-deviation", [](C& c) { return at(c.mrbm.initial_deviation); }, "0.01"},
      {"mrbm.mean-field-steps", [](C& c) { return at(c.mrbm.mean_field_steps); }, "5"},
      {"mrbm.epochs", [](C& c) { return at(c.mrbm.epochs); }, "1"},
      {"mrbm.joint-likelihood", [](C& c) { return at(c.mrbm.joint_likelihood); }, "false"},
      {"mrbm.perceptron-loss", [](C& c) { return at(c.mrbm.perceptron_loss); }, "false"},
      {"mrbm.gibbs-steps", [](C& c) { return at(c.mrbm.gibbs_steps); }, "1"},
      {"mrbm.persistent", [](C& c) { return at(c.mrbm.persistent); }, "false"},
      {"mrbm.sample-visible", [](C& c) { return at(c.mrbm.sample_visible); }, "false"},
      {"mrbm.adam", [](C& c) { return at(c.mrbm.adam); }, "true"},
      {"mrbm.momentum", [](C& c) { return at(c.mrbm.momentum); }, "0.9"},
      {"regeneration.gibbs-steps", [](C& c) { return at(c.regeneration.gibbs_steps); }, "1"},
      {"regeneration.mrbm-gibbs-steps", [](C& c) { return at(c.regeneration.mrbm_gibbs_steps); },
       "0"},
      {"regeneration.sampled", [](C& c) { return at(c.regeneration.sampled); }, "false"},
      {"fine-tuning.steps", [](C& c) { return at(c.fine_tuning.steps); }, "3000"},
      {"fine-tuning.view-uses", [](C& c) { return at(c.fine_tuning.view_uses); }, "0"},
      {"fine-tuning.from-greedy", [](C& c) { return at(c.fine_tuning.from_greedy); }, "true"},
      {"fine-tuning.windows", [](C& c) { return at(c.fine_tuning.windows); }, "48"},
      {"fine-tuning.people-power", [](C& c) { return at(c.fine_tuning.people_power); }, "0.5"},
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
  check_table(learning_settings());
}

TEST_CASE("learning settings: the list leaves no member out") {
  CHECK(member_count<CdSettings>() == listed_under<LearningSettings>("gaussian."));
  CHECK(member_count<CdSettings>() == listed_under<LearningSettings>("binary."));
  CHECK(member_count<MrbmSettings>() == listed_under<LearningSettings>("mrbm."));
  constexpr std::size_t kGroups = 5;
  CHECK(member_count<LearningSettings>() - kGroups ==
        listed_under<LearningSettings>("") - listed_under<LearningSettings>("gaussian.") -
            listed_under<LearningSettings>("binary.") - listed_under<LearningSettings>("mrbm.") -
            listed_under<LearningSettings>("fine-tuning.") -
            listed_under<LearningSettings>("regeneration."));
  CHECK(member_count<RegenerationSettings>() == listed_under<LearningSettings>("regeneration."));
  CHECK(member_count<FineTuningSettings>() == listed_under<LearningSettings>("fine-tuning."));
}

TEST_CASE(
    "learning settings: the greedy preset is two layers of the paper's size, trained longer") {
  CHECK(changed_by(LearningSettings::greedy()) == Values{{"order", "5"},
                                                         {"hidden", "300"},
                                                         {"layers", "2"},
                                                         {"mrbm-hidden", "300"},
                                                         {"gaussian.epochs", "100"},
                                                         {"binary.epochs", "50"},
                                                         {"mrbm.rate", "0.001"},
                                                         {"mrbm.epochs", "30"},
                                                         {"fine-tuning.steps", "0"}});
}

TEST_CASE("learning settings: the generation preset is one layer by CD-1 with noise on histories") {
  CHECK(changed_by(LearningSettings::generation()) == Values{{"order", "8"},
                                                             {"hidden", "600"},
                                                             {"mrbm-hidden", "300"},
                                                             {"people-power", "0"},
                                                             {"gaussian.gibbs-steps", "1"},
                                                             {"gaussian.rate", "0.003"},
                                                             {"gaussian.rate-A", "0.0001"},
                                                             {"gaussian.rate-B", "0.003"},
                                                             {"gaussian.history-noise", "1"},
                                                             {"gaussian.epochs", "200"},
                                                             {"gaussian.final-rate", "0.05"},
                                                             {"gaussian.cosine", "true"},
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
                 {"mrbm.adam", "false"},
                 {"regeneration.gibbs-steps", "3"},
                 {"regeneration.mrbm-gibbs-steps", "3"},
                 {"regeneration.sampled", "true"},
                 {"fine-tuning.steps", "0"},
                 {"binary.gibbs-steps", "5"}};
  for (const std::string kind : {"gaussian", "binary"}) {
    for (const std::string rate : {".rate", ".rate-A", ".rate-B"}) want[kind + rate] = "0.1";
    want[kind + ".momentum-from-epoch"] = "0";
    want[kind + ".weight-decay"] = "0";
    want[kind + ".initial-deviation"] = "1";
    want[kind + ".epochs"] = "100";
    want[kind + ".sample-visible"] = "true";
  }
  CHECK(changed_by(LearningSettings::paper()) == want);
  // What does not diverge: rates and first weights as usual, all else the paper's.
  for (const char* usual : {"least-batches", "gaussian.rate", "gaussian.rate-A", "gaussian.rate-B",
                            "gaussian.initial-deviation", "binary.rate", "binary.rate-A",
                            "binary.rate-B", "binary.initial-deviation", "mrbm.initial-deviation"})
    want.erase(usual);
  want["mrbm.rate"] = "0.001";
  CHECK(changed_by(LearningSettings::paper_stable()) == want);
}

TEST_CASE("learning settings: the defaults and the presets are within range") {
  CHECK_NOTHROW(LearningSettings{}.validate());
  CHECK_NOTHROW(LearningSettings::greedy().validate());
  CHECK_NOTHROW(LearningSettings::paper().validate());
  CHECK_NOTHROW(LearningSettings::paper_stable().validate());
  CHECK_NOTHROW(LearningSettings::generation().validate());
}

TEST_CASE("learning settings: what is out of range is refused by its name") {
  LearningSettings none;
  none.hidden = 0;
  CHECK_THROWS_AS(none.validate(), ConfigError);
  const auto refused = check_refused<LearningSettings>;
  const auto accepted = check_accepted<LearningSettings>;
  for (const char* name : {"hidden", "mrbm-hidden", "batch", "least-batches", "gaussian.epochs",
                           "binary.epochs", "mrbm.mean-field-steps", "mrbm.epochs",
                           "fine-tuning.windows", "fine-tuning.mean-field-steps"}) {
    refused(name, 0, "at least 1");
    accepted(name, 1);
  }
  for (const char* name : {"gaussian.gibbs-steps", "binary.gibbs-steps"}) {
    refused(name, 0, "at least 1 and at most 1000");
    refused(name, 1001, "at least 1 and at most 1000");
    accepted(name, 1);
  }
  for (const std::string kind : {"gaussian", "binary"}) {
    for (const double value : {0.0, 1.0, -0.1})
      refused(kind + ".sparsity-target", value, "above 0 and below 1");
    for (const double value : {-0.1, 1.1})
      refused(kind + ".final-rate", value, "at least 0 and at most 1");
    for (const char* name : {".fast-rate", ".sparsity-strength", ".l1", ".deviation-rate"}) {
      refused(kind + name, -1e-6, "at least 0");
      accepted(kind + name, 0);
    }
  }
  refused("layers", 0, "at least 1 and at most 64");
  refused("layers", 65, "at least 1 and at most 64");
  refused("fine-tuning.window-frames", 1, "at least 2");
  accepted("fine-tuning.window-frames", 2);
  for (const char* name : {"gaussian.rate", "binary.rate", "mrbm.rate", "fine-tuning.rate"}) {
    for (const double value : {0.0, -0.5, kNan}) refused(name, value, "above 0");
    refused(name, kInfinity, "a finite number");
    accepted(name, 1e-9);
  }
  for (const char* name :
       {"gaussian.momentum", "binary.momentum", "fine-tuning.dropout", "fine-tuning.average"}) {
    for (const double value : {1.0, -0.25, kNan}) refused(name, value, "at least 0 and below 1");
    accepted(name, 0);
    accepted(name, 0.999);
  }
  for (const char* name : {"people-power", "fine-tuning.people-power"})
    for (const double value : {-0.1, 1.1}) refused(name, value, "at least 0 and at most 1");
  for (const char* name :
       {"gaussian.rate-A", "gaussian.rate-B", "gaussian.weight-decay", "gaussian.initial-deviation",
        "binary.rate-A", "binary.rate-B", "binary.weight-decay", "binary.initial-deviation",
        "gaussian.history-noise", "binary.history-noise", "mrbm.weight-decay",
        "mrbm.initial-deviation", "fine-tuning.weight-decay", "fine-tuning.reverse"}) {
    refused(name, -1e-6, "at least 0");
    accepted(name, 0);
  }
}

TEST_CASE("learning settings: what may be nothing is accepted as nothing") {
  for (const char* name :
       {"seed", "order", "look-ahead", "gaussian.momentum-from-epoch", "binary.momentum-from-epoch",
        "fine-tuning.steps", "fine-tuning.from-greedy", "people-power", "fine-tuning.people-power",
        "fine-tuning.settle-frames"})
    check_accepted<LearningSettings>(name, 0);
}

TEST_CASE("learning settings: what no setting changes") {
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

TEST_CASE("learning settings: rates fall to their share along a line or a cosine, or stay") {
  CdSettings settings;
  settings.rate = 0.5;
  settings.rate_A = 0.25;
  settings.rate_B = 0.125;
  settings.deviation_rate = 2;
  const auto check = [&](double progress, double share) {
    const CdRule rule = cd_rule_for(settings, 1, progress);
    CHECK(rule.W.rate == doctest::Approx(0.5 * share));
    CHECK(rule.A.rate == doctest::Approx(0.25 * share));
    CHECK(rule.B.rate == doctest::Approx(0.125 * share));
    CHECK(rule.deviation_rate == doctest::Approx(2 * share));
  };
  for (const double progress : {0.0, 0.3, 1.0}) check(progress, 1);
  settings.final_rate = 0.2;
  check(0, 1);
  check(0.25, 0.8);
  check(1, 0.2);
  settings.cosine = true;
  check(0, 1);
  check(0.5, 0.6);
  check(0.25, 0.2 + 0.8 * 0.5 * (1 + std::sqrt(0.5)));
  check(1, 0.2);
}

TEST_CASE("learning settings: a rule of contrastive divergence takes over every option") {
  CdSettings settings;
  settings.gibbs_steps = 7;
  settings.weight_decay = 0.5;
  settings.momentum = 0.25;
  settings.l1 = 0.125;
  settings.sample_visible = true;
  settings.sparsity_target = 0.75;
  settings.sparsity_strength = 2;
  settings.fast_rate = 3;
  for (const std::size_t epoch : {1U, 6U}) {
    const CdRule rule = cd_rule_for(settings, epoch);
    CHECK(rule.gibbs_steps == 7);
    for (const UpdateRule* one : {&rule.W, &rule.A, &rule.B}) {
      CHECK(one->weight_decay == 0.5F);
      CHECK(one->l1 == 0.125F);
      CHECK(one->momentum == (epoch == 6 ? 0.25F : 0.0F));
    }
    CHECK(rule.sample_visible);
    CHECK(rule.sparsity_target == 0.75F);
    CHECK(rule.sparsity_strength == 2);
    CHECK(rule.fast_rate == 3);
  }
}

}  // namespace settings_test
