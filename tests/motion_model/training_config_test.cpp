// The settings of a training run on clips: the sum of its parts'.
#include "mcdbn/motion_model/training_config.hpp"

#include <doctest/doctest.h>

#include "base/settings_table.hpp"

namespace training_config_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using Own = Expected<TrainingConfig>;

const std::vector<Own>& own_settings() {
  using C = TrainingConfig;
  static const std::vector<Own> settings = {
      {"fine-tuning.positions", [](C& c) { return at(c.pose_loss.positions); }, "0.5"},
      {"fine-tuning.velocities", [](C& c) { return at(c.pose_loss.velocities); }, "0.2"},
      {"fine-tuning.contacts", [](C& c) { return at(c.pose_loss.contacts); }, "0.1"},
      {"fine-tuning.hold-out-among", [](C& c) { return at(c.hold_out_among); }, "20"}};
  return settings;
}

}  // namespace

TEST_CASE("training config: its settings are its parts' and the loss's, with their defaults") {
  Values want = values_of(LearningSettings{});
  want.merge(values_of(CorpusSettings{}));
  for (const Own& own : own_settings()) want[own.name] = own.default_value;
  want["half-precision"] = "false";
  CHECK(values_of(TrainingConfig{}) == want);
  TrainingConfig half;
  half.half_precision = true;
  CHECK(changed_by(half) == Values{{"half-precision", "true"}});
  for (const Own& own : own_settings()) {
    TrainingConfig config;
    set(config, own.name, 7);
    CHECK(text_of(own.member(config)) == "7");
    CHECK(changed_by(config) == Values{{own.name, "7"}});
  }
  // What the loss weighs the others by, and which feet count as planted, is no setting.
  CHECK(member_count<PoseLossWeights>() == own_settings().size() - 1 + 2);
}

TEST_CASE("training config: presets are those of learning") {
  CHECK(changed_by(TrainingConfig::greedy()) == changed_by(LearningSettings::greedy()));
  CHECK(changed_by(TrainingConfig::paper()) == changed_by(LearningSettings::paper()));
  CHECK(changed_by(TrainingConfig::paper_stable()) == changed_by(LearningSettings::paper_stable()));
  Values generation = changed_by(LearningSettings::generation());
  generation["phases"] = "4";
  generation["directions"] = "4";
  generation["gaussian.epochs"] = "50";  // learning's have a fourth of the frames
  generation["binary.epochs"] = "12";
  generation["mrbm.epochs"] = "7";
  CHECK(changed_by(TrainingConfig::generation()) == generation);
  for (const TrainingConfig& config :
       {TrainingConfig{}, TrainingConfig::greedy(), TrainingConfig::paper(),
        TrainingConfig::paper_stable(), TrainingConfig::generation(), TrainingConfig::general()})
    CHECK_NOTHROW(config.validate());
}

TEST_CASE("training config: the preset for many people is that of docs/corpus.md") {
  const TrainingConfig general = TrainingConfig::general();
  CHECK(changed_by(general) == Values{{"augment.detector", "0.8"},
                                      {"augment.limbs-exchanged", "0.5"},
                                      {"augment.limbs-turned", "0.4"},
                                      {"augment.arms-anywhere", "0.35"},
                                      {"augment.leaning", "0.25"},
                                      {"augment.turning-round", "0.25"},
                                      {"augment.gravity", "1.5"},
                                      {"fine-tuning.steps", "30000"},
                                      {"fine-tuning.view-uses", "16"},
                                      {"fine-tuning.weight-decay", "0.1"},
                                      {"fine-tuning.windows", "40"},
                                      {"fine-tuning.settle-frames", "10"},
                                      {"fine-tuning.hold-out-among", "0"}});
  CHECK(general.skeleton == SkeletonUse::humanoid);
}

TEST_CASE("training config: its parts' ranges hold, and its own") {
  TrainingConfig none;
  none.batch = 0;
  CHECK_THROWS_AS(none.validate(), ConfigError);
  const auto refused = check_refused<TrainingConfig>;
  refused("hidden", 0, "at least 1");
  refused("camera.fov", 180, "above 0 and below 180");
  for (const Own& own : own_settings()) {
    if (std::string(own.name) != "fine-tuning.hold-out-among") refused(own.name, -1, "at least 0");
    check_accepted<TrainingConfig>(own.name, 0);
  }
}

TEST_CASE("training config: fine-tuning's settings had other names") {
  CHECK(former_name("fine-tuning.rate") == "joint.rate");
  CHECK(former_name("fine-tuning.positions") == "joint.places");
  CHECK(former_name("gaussian.rate").empty());
}

}  // namespace training_config_test
