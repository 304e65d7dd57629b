// Where the greedy stages stop by themselves, and their messages.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "learning/divergence_guard.hpp"
#include "learning/greedy_scene.hpp"
#include "mcdbn/base/errors.hpp"

namespace greedy_guard_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Divergence {
  std::string message;         ///< empty if there was none
  std::vector<double> losses;  ///< of the epochs before, of the stage that diverged
  double last_loss = 0;        ///< the one that stopped it, as the message has it
};

/// Runs a training that is to diverge. @param train given an observer
template <typename Train>
Divergence divergence_of(const Train& train) {
  Divergence result;
  std::string stage;
  try {
    train([&](const EpochReport& report) {
      if (report.stage != stage) result.losses.clear();
      stage = report.stage;
      result.losses.push_back(report.loss);
    });
  } catch (const DivergenceError& error) {
    result.message = error.what();
    const std::string before_loss = "the loss is ";
    const auto at = result.message.find(before_loss);
    if (at != std::string::npos)
      result.last_loss = std::strtod(result.message.c_str() + at + before_loss.size(), nullptr);
  }
  return result;
}

/// It was stopped because the loss grew to several times the best, not because it was no number.
void check_growth(const Divergence& divergence) {
  INFO(divergence.message);
  REQUIRE(!divergence.message.empty());
  REQUIRE(!divergence.losses.empty());
  const double best = *std::min_element(divergence.losses.begin(), divergence.losses.end());
  CHECK(std::isfinite(divergence.last_loss));
  CHECK(divergence.last_loss > 4 * best);
  CHECK(*std::max_element(divergence.losses.begin(), divergence.losses.end()) <= 4 * best);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Frames of waves, each column standardized.
MatrixF waves(Eigen::Index frames, Eigen::Index dimension) {
  MatrixF values(frames, dimension);
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index d = 0; d < dimension; ++d)
      values(t, d) = std::sqrt(2.0F) *
                     std::sin(0.2F * static_cast<float>(t) * (1.0F + 0.1F * static_cast<float>(d)) +
                              static_cast<float>(d));
  return values;
}

/// Rows of variance 1: two causes of ±1, each in four columns, and noise on every column.
MatrixF noisy_causes(Eigen::Index rows, double noise) {
  constexpr Eigen::Index kColumns = 8, kOfCause = 4;
  const RandomKey key{.seed = 3};
  MatrixF values(rows, kColumns);
  for (Eigen::Index r = 0; r < rows; ++r)
    for (Eigen::Index c = 0; c < kColumns; ++c) {
      const auto row = static_cast<std::uint32_t>(r), column = static_cast<std::uint32_t>(c);
      const auto first = static_cast<std::uint32_t>(c / kOfCause * kOfCause);
      const double cause = random_uniform({.seed = 4}, row, first) < 0.5F ? -1.0 : 1.0;
      values(r, c) = static_cast<float>((cause + noise * random_normal(key, row, column)) /
                                        std::sqrt(1 + noise * noise));
    }
  return values;
}

}  // namespace

TEST_CASE("a loss that grows while it is finite stops the greedy training at that epoch") {
  GreedyScene scene = scene_of_different_sizes();
  scene.plan.gaussian = {.gibbs_steps = 3,
                         .rate = 0.07,
                         .rate_A = 0.7,
                         .rate_B = 0.021,
                         .momentum = 0.3,
                         .momentum_from_epoch = 9,
                         .weight_decay = 0,
                         .initial_deviation = 0.31,
                         .epochs = 8};
  scene.plan.least_batches = 1;
  const std::vector<double> losses = train_on_host(scene).stages.front().losses;
  std::size_t stop = 0;  // losses[stop] is the first that is too large
  for (double best = losses[0]; stop < losses.size() && losses[stop] <= 4 * best; ++stop)
    best = std::min(best, losses[stop]);
  REQUIRE(stop > 0);
  REQUIRE(stop < losses.size());
  REQUIRE(std::isfinite(losses[stop]));
  on_every_device([&](Device& device) {
    const Divergence divergence = divergence_of(
        [&](const EpochObserver& observer) { train_on_device(device, scene, observer); });
    check_growth(divergence);
    CHECK(divergence.losses.size() == stop);
    CHECK(contains(divergence.message, "in stage pose.0 at epoch " + std::to_string(stop + 1)));
    CHECK(contains(divergence.message,
                   "; lower `gaussian.rate` (now 0.07), `gaussian.rate-A` (0.7), "
                   "`gaussian.rate-B` (0.021) or `gaussian.initial-deviation` (0.31)"));
  });
}

TEST_CASE("the paper's own rates and weights make the loss grow, which stops them") {
  LearningSettings settings = LearningSettings::paper();
  settings.batch = 20;  // a few clips only
  const CrbmShape shape{12, 20, settings.order, VisibleKind::gaussian};
  const RandomKey key{.seed = 1};
  on_every_device([&](Device& device) {
    const Sequences frames = Sequences::from_host(device, {waves(90, 12), waves(60, 12)});
    const Divergence divergence = divergence_of([&](const EpochObserver& observer) {
      train_crbm(device, frames,
                 CrbmParameters::random(shape, settings.gaussian.initial_deviation, key),
                 settings.gaussian, settings, 0, observer);
    });
    check_growth(divergence);
    CHECK(contains(divergence.message, "in stage crbm at epoch "));
    CHECK(contains(divergence.message, "lower `gaussian.rate` (now 0.1)"));
  });
}

TEST_CASE("the paper's preset at rates that do not diverge learns what the other loses") {
  LearningSettings settings = LearningSettings::paper_stable();
  settings.batch = 20;
  settings.gaussian.epochs = 40;
  const CrbmShape shape{12, 20, settings.order, VisibleKind::gaussian};
  const RandomKey key{.seed = 1};
  on_every_device([&](Device& device) {
    const Sequences frames = Sequences::from_host(device, {waves(90, 12), waves(60, 12)});
    std::vector<double> losses;
    train_crbm(device, frames,
               CrbmParameters::random(shape, settings.gaussian.initial_deviation, key),
               settings.gaussian, settings, 0,
               [&](const EpochReport& report) { losses.push_back(report.loss); });
    CHECK(losses.size() == 40);
    constexpr double kDraws = 1.0;  // the variance of drawn visible units, which no training takes
    CHECK(losses.back() - kDraws < 0.25 * (losses.front() - kDraws));
  });
}

TEST_CASE("the greedy training names the modality, the kind of layer and the settings to lower") {
  GreedyScene scene = scene_of_different_sizes();
  scene.tracks.back()(5, 1) = 1e30F;  // whose square is infinite
  on_every_device([&](Device& device) {
    const Divergence track = divergence_of(
        [&](const EpochObserver& observer) { train_on_device(device, scene, observer); });
    INFO(track.message);
    CHECK(contains(track.message, "in stage track.0 at epoch 1: the loss is "));
    CHECK_FALSE(std::isfinite(track.last_loss));
    CHECK(contains(track.message, "; lower `gaussian.rate` (now 0.03)"));

    const LearningSettings settings = settings_of(scene.plan);
    const MatrixF codes = waves(20, 4).cwiseAbs() / 2;
    CrbmParameters start = CrbmParameters::random({4, 4, 2, VisibleKind::binary}, 0.1, {});
    start.a(0, 2) = std::numeric_limits<float>::quiet_NaN();
    const Divergence binary = divergence_of([&](const EpochObserver& observer) {
      train_crbm(device, Sequences::from_host(device, {codes}), start, settings.binary, settings, 1,
                 observer, "upper");
    });
    INFO(binary.message);
    CHECK_FALSE(std::isfinite(binary.last_loss));
    CHECK(contains(binary.message, "in stage upper at epoch 1: the loss is "));
    CHECK(contains(binary.message,
                   "; lower `binary.rate` (now 0.2), `binary.rate-A` (0.07), `binary.rate-B` (0.1) "
                   "or `binary.initial-deviation` (0.7)"));
  });
}

TEST_CASE("the message names the settings that the layer uses, and no others") {
  CdSettings settings{.rate = 0.5, .rate_A = 0.25, .rate_B = 0.125, .initial_deviation = 0.75};
  settings.fast_rate = 0.375;  // of persistent chains only
  settings.deviation_rate = 3;
  constexpr VisibleKind kGaussian = VisibleKind::gaussian;
  CHECK(what_to_lower({5, 3, 0, kGaussian}, settings) ==
        "lower `gaussian.rate` (now 0.5), `gaussian.deviation-rate` (3) or "
        "`gaussian.initial-deviation` (0.75)");
  CHECK(what_to_lower({5, 3, 2, kGaussian}, settings) ==
        "lower `gaussian.rate` (now 0.5), `gaussian.rate-A` (0.25), `gaussian.rate-B` (0.125) or "
        "`gaussian.initial-deviation` (0.75)");
  CHECK(what_to_lower({5, 3, 2, VisibleKind::binary, 0, 2}, settings) ==
        "lower `binary.rate` (now 0.5), `binary.rate-B` (0.125) or `binary.initial-deviation` "
        "(0.75)");
  settings.persistent = true;
  CHECK(what_to_lower({5, 3, 0, VisibleKind::binary}, settings) ==
        "lower `binary.rate` (now 0.5), `binary.fast-rate` (0.375) or `binary.initial-deviation` "
        "(0.75)");
}

TEST_CASE("a Gaussian RBM whose deviation diverges is stopped, and the message names its rate") {
  LearningSettings settings;
  settings.batch = 20;
  settings.least_batches = 1;
  settings.gaussian.epochs = 20;
  settings.gaussian.deviation_rate = 100;
  on_every_device([&](Device& device) {
    const Sequences frames = Sequences::from_host(device, {waves(90, 12)});
    const Divergence divergence = divergence_of([&](const EpochObserver& observer) {
      train_crbm(device, frames,
                 CrbmParameters::random({12, 8, 0, VisibleKind::gaussian}, 0.01, {.seed = 1}),
                 settings.gaussian, settings, 0, observer);
    });
    INFO(divergence.message);
    CHECK(contains(divergence.message, "`gaussian.deviation-rate` (100)"));
    CHECK_FALSE(contains(divergence.message, "rate-A"));
  });
}

TEST_CASE("a deviation that shrinks to that of the noise is no divergence: the loss falls to it") {
  constexpr double kNoise = 0.1;
  LearningSettings settings;
  settings.batch = 20;
  settings.least_batches = 1;
  settings.gaussian.gibbs_steps = 1;
  settings.gaussian.rate = settings.gaussian.deviation_rate = 0.02;
  settings.gaussian.epochs = 120;
  on_every_device([&](Device& device) {
    std::vector<double> losses;
    const Sequences rows = Sequences::from_host(device, {noisy_causes(200, kNoise)});
    const auto train = [&] {
      return train_crbm(device, rows,
                        CrbmParameters::random({8, 4, 0, VisibleKind::gaussian}, 0.01, {.seed = 1}),
                        settings.gaussian, settings, 0,
                        [&](const EpochReport& report) { losses.push_back(report.loss); });
    };
    std::optional<Crbm> crbm;
    REQUIRE_NOTHROW(crbm.emplace(train()));
    // Over the deviation the error would rise from a tenth to nearly 1.
    CHECK(crbm->visible_deviation.to_host().maxCoeff() < 2 * kNoise);
    CHECK(losses.front() > 0.8);
    CHECK(losses.back() < 2 * kNoise * kNoise);
  });
}

TEST_CASE("a deviation that is to be learnt from values that were not seen is refused at once") {
  const auto source = [](float seen) {
    std::vector<ModalityMatrices> modalities{{"track", {waves(30, 4)}}, {"pose", {waves(30, 5)}}};
    MatrixF mask = MatrixF::Ones(30, 4);
    mask(7, 2) = seen;
    modalities[0].clips[0](7, 2) *= seen;
    modalities[0].seen = {mask};
    return MatrixSource(std::move(modalities));
  };
  LearningSettings settings = settings_of(tiny_plan());
  settings.order = 0;
  settings.gaussian.rate = 1e-3;
  settings.gaussian.deviation_rate = 0.01;
  on_every_device([&](Device& device) {
    bool has_begun = false;
    const EpochObserver observer = [&](const EpochReport&) { has_begun = true; };
    CHECK_THROWS_WITH_AS(train_greedy(device, source(0), settings, observer),
                         doctest::Contains("`gaussian.deviation-rate` (now 0.01)"), ConfigError);
    CHECK_FALSE(has_begun);
    // What says that all was seen is as good as nothing.
    const Mcdbn network = train_greedy(device, source(1), settings, observer);
    CHECK(network.cdbns[0].layers[0].has_deviation);
    CHECK(has_begun);
  });
}

TEST_CASE("an MRBM whose loss grows is stopped, and the message names what to lower") {
  LearningSettings settings = settings_of(tiny_plan());
  settings.mrbm.rate = 40;
  settings.mrbm.weight_decay = 0;
  settings.mrbm.epochs = 3;
  settings.least_batches = 1;  // one mini-batch an epoch: the first epoch's loss is still small
  const MrbmParameters initial = MrbmParameters::random(two_modalities(4, 4, 6), 0.4, {.seed = 3});
  const MatrixF codes = waves(settings.batch + settings.look_ahead, 4).cwiseAbs() / 2;
  on_every_device([&](Device& device) {
    const std::vector<Sequences> sequences(2, Sequences::from_host(device, {codes}));
    const Divergence divergence = divergence_of([&](const EpochObserver& observer) {
      train_mrbm(device, sequences, initial, settings, 128, observer);
    });
    check_growth(divergence);
    CHECK(contains(divergence.message, "in stage mrbm at epoch 2: the loss is "));
    CHECK(contains(divergence.message,
                   "; lower `mrbm.rate` (now 40) or `mrbm.initial-deviation` (now 0.4)"));
  });
}

}  // namespace greedy_guard_test
