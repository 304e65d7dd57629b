// The settings of the baselines that have some: defaults, ranges.

#include <doctest/doctest.h>

#include "base/settings_table.hpp"
#include "comparison/bimodal_autoencoder.hpp"
#include "comparison/multimodal_dbm.hpp"
#include "comparison/twin_gaussian_processes.hpp"

namespace baseline_settings_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const std::vector<Expected<BimodalAutoencoderSettings>>& autoencoder_settings() {
  using C = BimodalAutoencoderSettings;
  static const std::vector<Expected<C>> settings = {
      {"track-hidden", [](C& c) { return at(c.track_hidden); }, "256"},
      {"pose-hidden", [](C& c) { return at(c.pose_hidden); }, "128"},
      {"shared", [](C& c) { return at(c.shared); }, "256"},
      {"pretraining-epochs", [](C& c) { return at(c.pretraining_epochs); }, "20"},
      {"pretraining-rate", [](C& c) { return at(c.pretraining_rate); }, "0.001"},
      {"epochs", [](C& c) { return at(c.epochs); }, "20"},
      {"least-batches", [](C& c) { return at(c.least_batches); }, "40"},
      {"batch", [](C& c) { return at(c.batch); }, "99"},
      {"rate", [](C& c) { return at(c.rate); }, "0.001"},
      {"weight-decay", [](C& c) { return at(c.weight_decay); }, "3"},
      {"pose-weight", [](C& c) { return at(c.pose_weight); }, "1"},
      {"seed", [](C& c) { return at(c.seed); }, "1"}};
  return settings;
}

const std::vector<Expected<MultimodalDbmSettings>>& dbm_settings() {
  using C = MultimodalDbmSettings;
  static const std::vector<Expected<C>> settings = {
      {"track-hidden", [](C& c) { return at(c.track_hidden); }, "256"},
      {"pose-hidden", [](C& c) { return at(c.pose_hidden); }, "128"},
      {"joint", [](C& c) { return at(c.joint); }, "128"},
      {"pretraining-epochs", [](C& c) { return at(c.pretraining_epochs); }, "5"},
      {"epochs", [](C& c) { return at(c.epochs); }, "30"},
      {"least-batches", [](C& c) { return at(c.least_batches); }, "40"},
      {"batch", [](C& c) { return at(c.batch); }, "100"},
      {"pretraining-rate", [](C& c) { return at(c.pretraining_rate); }, "0.001"},
      {"rate", [](C& c) { return at(c.rate); }, "0.001"},
      {"momentum", [](C& c) { return at(c.momentum); }, "0.5"},
      {"weight-decay", [](C& c) { return at(c.weight_decay); }, "0.0002"},
      {"mean-field-steps", [](C& c) { return at(c.mean_field_steps); }, "5"},
      {"gibbs-sweeps", [](C& c) { return at(c.gibbs_sweeps); }, "2"},
      {"inference-steps", [](C& c) { return at(c.inference_steps); }, "10"},
      {"seed", [](C& c) { return at(c.seed); }, "1"}};
  return settings;
}

const std::vector<Expected<TwinGaussianProcessSettings>>& twin_settings() {
  using C = TwinGaussianProcessSettings;
  static const std::vector<Expected<C>> settings = {
      {"neighbours", [](C& c) { return at(c.neighbours); }, "300"},
      {"track-width", [](C& c) { return at(c.track_width); }, "1"},
      {"pose-width", [](C& c) { return at(c.pose_width); }, "1"},
      {"track-noise", [](C& c) { return at(c.track_noise); }, "0.001"},
      {"pose-noise", [](C& c) { return at(c.pose_noise); }, "1"},
      {"steps", [](C& c) { return at(c.steps); }, "50"}};
  return settings;
}

}  // namespace

TEST_CASE("baselines' settings: every one has its default, its own name and its own member") {
  check_table(autoencoder_settings());
  check_table(dbm_settings());
  check_table(twin_settings());
  CHECK(member_count<BimodalAutoencoderSettings>() == autoencoder_settings().size());
  CHECK(member_count<MultimodalDbmSettings>() == dbm_settings().size());
  CHECK(member_count<TwinGaussianProcessSettings>() == twin_settings().size());
}

TEST_CASE("baselines' settings: what is out of range is refused by its name") {
  for (const char* name : {"track-hidden", "pose-hidden", "shared", "epochs", "least-batches"}) {
    check_refused<BimodalAutoencoderSettings>(name, 0, "at least 1");
    check_accepted<BimodalAutoencoderSettings>(name, 1);
  }
  check_refused<BimodalAutoencoderSettings>("batch", 2, "at least 3");
  check_accepted<BimodalAutoencoderSettings>("batch", 3);
  for (const char* name : {"rate", "pretraining-rate", "pose-weight"})
    check_refused<BimodalAutoencoderSettings>(name, 0, "above 0");
  check_accepted<BimodalAutoencoderSettings>("pretraining-epochs", 0);
  check_refused<BimodalAutoencoderSettings>("weight-decay", -1, "at least 0");

  for (const char* name : {"track-hidden", "pose-hidden", "joint", "least-batches", "batch",
                           "mean-field-steps", "inference-steps"}) {
    check_refused<MultimodalDbmSettings>(name, 0, "at least 1");
    check_accepted<MultimodalDbmSettings>(name, 1);
  }
  check_refused<MultimodalDbmSettings>("gibbs-sweeps", 1001, "at least 1 and at most 1000");
  check_refused<MultimodalDbmSettings>("momentum", 1, "at least 0 and below 1");
  for (const char* name : {"rate", "pretraining-rate"})
    check_refused<MultimodalDbmSettings>(name, 0, "above 0");
  for (const char* name : {"epochs", "pretraining-epochs", "weight-decay"})
    check_accepted<MultimodalDbmSettings>(name, 0);

  check_refused<TwinGaussianProcessSettings>("neighbours", 0, "at least 1");
  for (const char* name : {"track-width", "pose-width", "track-noise", "pose-noise"})
    check_refused<TwinGaussianProcessSettings>(name, 0, "above 0");
  check_accepted<TwinGaussianProcessSettings>("steps", 0);
}

}  // namespace baseline_settings_test
