#include "mcdbn/learning/greedy_schedule.hpp"

#include <doctest/doctest.h>

#include <functional>

#include "base/capture_bound.hpp"
#include "learning/greedy_scene.hpp"
#include "mcdbn/base/errors.hpp"

namespace greedy_schedule_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A machine whose parameters all differ, for training to start from; its means of visible units
/// are no clip's.
Mcdbn made_up_machine(Device& device, const GreedyScene& scene) {
  unsigned seed = 900;
  const auto fill = [&](MatrixF& matrix, float scale) {
    matrix = random_matrix(static_cast<std::size_t>(matrix.rows()),
                           static_cast<std::size_t>(matrix.cols()), seed++, scale);
  };
  const LearningSettings settings = settings_of(scene.plan);
  const auto cdbn = [&](Eigen::Index dimension) {
    Cdbn result;
    CrbmShape shape{static_cast<std::size_t>(dimension), settings.hidden, settings.order,
                    VisibleKind::gaussian};
    while (result.layers.size() < settings.layers) {
      CrbmParameters p = CrbmParameters::zeros(shape);
      for (MatrixF* weights : {&p.W, &p.A, &p.B}) fill(*weights, 0.4F);
      for (MatrixF* biases : {&p.a, &p.b, &p.visible_mean}) fill(*biases, 0.7F);
      result.layers.emplace_back(device, p);
      shape = {settings.hidden, settings.hidden, settings.order, VisibleKind::binary};
    }
    return result;
  };
  Cdbn track = cdbn(scene.tracks.front().cols()), pose = cdbn(scene.poses.front().cols());
  MrbmParameters p =
      MrbmParameters::zeros(two_modalities(settings.hidden, settings.hidden, settings.mrbm_hidden));
  for (MatrixF* matrix : {&p.W[0], &p.W[1], &p.a[0], &p.a[1], &p.b}) fill(*matrix, 0.5F);
  return {{std::move(track), std::move(pose)}, Mrbm(device, p)};
}

void check_layers(const Cdbn& cdbn, Eigen::Index dimension, const reference::GreedyPlan& plan) {
  REQUIRE(cdbn.layers.size() == static_cast<std::size_t>(plan.layers));
  const auto hidden = static_cast<std::size_t>(plan.hidden);
  const auto order = static_cast<std::size_t>(plan.order);
  for (std::size_t i = 0; i < cdbn.layers.size(); ++i) {
    const CrbmShape below{static_cast<std::size_t>(dimension), hidden, order,
                          VisibleKind::gaussian};
    const CrbmShape above{hidden, hidden, order, VisibleKind::binary};
    CHECK(cdbn.layers[i].shape() == (i == 0 ? below : above));
  }
}

void check_training(const GreedyScene& scene) {
  const reference::GreedyRun want = train_on_host(scene);
  REQUIRE(want.closest_draw > kClosestDraw);
  on_every_device([&](Device& device) {
    const Mcdbn got = train_on_device(device, scene);
    check_layers(got.cdbns[1], scene.poses.front().cols(), scene.plan);
    check_layers(got.cdbns[0], scene.tracks.front().cols(), scene.plan);
    CHECK(got.look_ahead == static_cast<std::size_t>(scene.plan.look_ahead));
    CHECK(got.mean_field_steps == static_cast<std::size_t>(scene.plan.mrbm.mean_field_steps));
    CHECK(got.fills_gaps);
    check_machine(got, want.machine);
  });
}

double difference(const reference::GreedyMachine& x, const reference::GreedyMachine& y) {
  const auto x_tensors = tensors_of(x), y_tensors = tensors_of(y);
  double largest = 0;
  for (const auto& [name, tensor] : x_tensors)
    if (tensor.size() > 0)
      largest = std::max(largest, (tensor - y_tensors.at(name)).cwiseAbs().maxCoeff());
  return largest;
}

using PlanChange = std::pair<const char*, std::function<void(reference::GreedyPlan&)>>;

const std::vector<PlanChange>& plan_changes() {
  using Plan = reference::GreedyPlan;
  static const std::vector<PlanChange> changes = {
      {"seed", [](Plan& p) { ++p.seed; }},
      {"upper half of the seed", [](Plan& p) { p.seed += 1ULL << 32; }},
      {"look-ahead", [](Plan& p) { --p.look_ahead; }},
      {"batch", [](Plan& p) { ++p.batch; }},
      {"least batches", [](Plan& p) { p.least_batches = 12; }},
      {"gaussian: Gibbs steps", [](Plan& p) { --p.gaussian.gibbs_steps; }},
      {"gaussian: rates of A and B swapped",
       [](Plan& p) { std::swap(p.gaussian.rate_A, p.gaussian.rate_B); }},
      {"gaussian: rates of W and B swapped",
       [](Plan& p) { std::swap(p.gaussian.rate, p.gaussian.rate_B); }},
      {"gaussian: momentum", [](Plan& p) { p.gaussian.momentum = p.binary.momentum; }},
      {"gaussian: momentum early", [](Plan& p) { --p.gaussian.momentum_from_epoch; }},
      {"gaussian: momentum late", [](Plan& p) { ++p.gaussian.momentum_from_epoch; }},
      {"gaussian: no decay", [](Plan& p) { p.gaussian.weight_decay = 0; }},
      {"gaussian: deviation",
       [](Plan& p) { p.gaussian.initial_deviation = p.binary.initial_deviation; }},
      {"gaussian: noise", [](Plan& p) { p.gaussian.history_noise = 0.1; }},
      {"gaussian: fewer epochs", [](Plan& p) { --p.gaussian.epochs; }},
      {"gaussian: more epochs", [](Plan& p) { ++p.gaussian.epochs; }},
      {"binary: Gibbs steps", [](Plan& p) { ++p.binary.gibbs_steps; }},
      {"binary: rates of A and B swapped",
       [](Plan& p) { std::swap(p.binary.rate_A, p.binary.rate_B); }},
      {"binary: momentum early", [](Plan& p) { --p.binary.momentum_from_epoch; }},
      {"binary: momentum late", [](Plan& p) { ++p.binary.momentum_from_epoch; }},
      {"binary: no decay", [](Plan& p) { p.binary.weight_decay = 0; }},
      {"binary: noise", [](Plan& p) { p.binary.history_noise = 0.1; }},
      {"binary: fewer epochs", [](Plan& p) { --p.binary.epochs; }},
      {"settings of the kinds swapped", [](Plan& p) { std::swap(p.gaussian, p.binary); }},
      {"mrbm: rate", [](Plan& p) { p.mrbm.rate *= 1.3; }},
      {"mrbm: no decay", [](Plan& p) { p.mrbm.weight_decay = 0; }},
      {"mrbm: deviation", [](Plan& p) { p.mrbm.initial_deviation *= 1.5; }},
      {"mrbm: mean-field steps", [](Plan& p) { --p.mrbm.mean_field_steps; }},
      {"mrbm: fewer epochs", [](Plan& p) { --p.mrbm.epochs; }}};
  return changes;
}

}  // namespace

TEST_CASE("greedy training gives the double reference's parameters: all sizes differ") {
  check_training(scene_of_different_sizes());
}

TEST_CASE("greedy training gives the double reference's parameters: all sizes are equal") {
  check_training(scene_of_equal_sizes());
}

TEST_CASE("greedy training gives the double reference's parameters: no history") {
  check_training(scene_without_history());
}

TEST_CASE("greedy training gives the double reference's parameters: histories with noise") {
  check_training(scene_with_history_noise());
}

TEST_CASE("greedy training gives the double reference's parameters: rare people drawn more often") {
  check_training(scene_with_rare_people());
  CHECK(difference(train_on_host(scene_with_rare_people()).machine,
                   train_on_host(scene_of_different_sizes()).machine) > 1e3 * kGreedyTolerance);
}

TEST_CASE("greedy training goes on from the weights that it is given, and leaves them alone") {
  GreedyScene scene = scene_of_equal_sizes();
  scene.plan.seed = 0x500000005U;  // its draws are not close
  // Nobody looks at them: a training that did would be far off.
  scene.plan.gaussian.initial_deviation = scene.plan.binary.initial_deviation = 3;
  scene.plan.mrbm.initial_deviation = 3;
  on_every_device([&](Device& device) {
    const Mcdbn start = made_up_machine(device, scene);
    const reference::GreedyMachine before = machine_in_double(start);
    const reference::GreedyRun want = train_on_host(scene, &before);
    REQUIRE(want.closest_draw > kClosestDraw);
    const Mcdbn got = train_on_device(device, scene, {}, &start);
    check_machine(got, want.machine);
    CHECK(difference(machine_in_double(start), before) == 0);
    CHECK(got.look_ahead == static_cast<std::size_t>(scene.plan.look_ahead));
    CHECK(got.mean_field_steps == static_cast<std::size_t>(scene.plan.mrbm.mean_field_steps));
  });
}

TEST_CASE("every setting counts: another one moves parameters far beyond the tolerance") {
  const GreedyScene scene = scene_of_different_sizes();
  const reference::GreedyMachine right = train_on_host(scene).machine;
  for (const auto& [what, change] : plan_changes()) {
    GreedyScene other = scene;
    change(other.plan);
    CAPTURE_BOUND(what);
    CHECK(difference(right, train_on_host(other).machine) > 1000 * kGreedyTolerance);
  }
}

TEST_CASE("the same settings give the same bits, watched or not") {
  const GreedyScene scene = scene_of_different_sizes();
  on_every_device([&](Device& device) {
    const auto once = machine_in_double(train_on_device(device, scene));
    const auto watched =
        machine_in_double(train_on_device(device, scene, [](const EpochReport&) {}));
    CHECK(difference(once, watched) == 0);
  });
}

TEST_CASE("a code that is always on or off gives the MRBM biases of a bounded size") {
  GreedyScene scene = scene_of_different_sizes();
  scene.plan.seed = 11;  // some units are on, some off, of either modality
  scene.plan.layers = 1;
  scene.plan.gaussian.initial_deviation = 100;  // saturates nearly every hidden unit
  scene.plan.gaussian.epochs = scene.plan.mrbm.epochs = 1;
  scene.plan.gaussian.rate = scene.plan.gaussian.rate_A = scene.plan.gaussian.rate_B = 1e-30;
  scene.plan.mrbm.rate = 1e-30;
  for (std::size_t i = 0; i < scene.poses.size(); ++i) {  // one frame over and over
    scene.poses[i].rowwise() = RowVectorF(RowVectorF::LinSpaced(5, 0.5F, 1.5F));
    scene.tracks[i].rowwise() = RowVectorF(RowVectorF::LinSpaced(3, 0.5F, 1.5F));
  }
  const double most = std::log((1 - 1e-4) / 1e-4);
  on_every_device([&](Device& device) {
    const MrbmParameters got = train_on_device(device, scene).mrbm.to_host();
    for (const MatrixF& a : got.a) {
      CHECK(a.minCoeff() == doctest::Approx(-most).epsilon(1e-3));
      CHECK(a.maxCoeff() == doctest::Approx(most).epsilon(1e-3));
    }
  });
}

TEST_CASE("greedy training refuses settings out of range and clips that are all too short") {
  on_every_device([&](Device& device) {
    GreedyScene scene = scene_of_different_sizes();
    scene.plan.batch = 0;
    CHECK_THROWS_AS(train_on_device(device, scene), ConfigError);
    scene = scene_of_different_sizes();
    scene.plan.order = 17;  // the longest clip has 17 frames
    CHECK_THROWS_AS(train_on_device(device, scene), ShapeError);
    scene = scene_of_different_sizes();
    scene.plan.gaussian.epochs = scene.plan.binary.epochs = 1;
    scene.plan.look_ahead = 13;  // the first code is that of frame 4
    CHECK_THROWS_AS(train_on_device(device, scene), ShapeError);
    scene.plan.look_ahead = 12;
    CHECK_NOTHROW(train_on_device(device, scene));
  });
}

}  // namespace greedy_schedule_test
