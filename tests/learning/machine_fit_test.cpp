// A machine fitted by itself: what it learns, and that each layer is what train_crbm makes of it.

#include "mcdbn/learning/machine_fit.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "device/every_device.hpp"
#include "machines/in_double.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "reference/crbm_enumeration.hpp"

namespace machine_fit_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

MachineSettings small_settings() {
  MachineSettings settings;
  settings.seed = 5;
  settings.hidden = 4;
  settings.batch = 10;
  settings.gaussian.epochs = 2;
  settings.binary.epochs = 3;
  settings.binary.rate = 0.02;
  return settings;
}

Sequences clips(Device& device, std::size_t columns) {
  return Sequences::from_host(device,
                              {random_matrix(30, columns, 1), random_matrix(17, columns, 2)});
}

}  // namespace

TEST_CASE("each layer of a stack is trained on the code beneath, with numbers of its own") {
  on_every_device([](Device& device) {
    const MachineSettings settings = small_settings();
    const Sequences data = clips(device, 3);
    const Cdbn stack = fit_stack(device, data, kGaussian, {{4, 2}, {4, 2}}, settings);
    REQUIRE(stack.layers.size() == 2);
    LearningSettings learning;
    learning.seed = 5;
    learning.batch = 10;
    learning.least_batches = 1;
    const auto check = [&](std::size_t layer, const Sequences& visible, VisibleKind kind,
                           const CdSettings& rule) {
      const auto stream = static_cast<std::uint16_t>(layer);
      const CrbmParameters start = CrbmParameters::random(
          {visible.values.columns(), 4, 2, kind}, rule.initial_deviation, {5, 0, stream, 0x7100});
      const CrbmParameters want =
          train_crbm(device, visible, start, rule, learning, stream).to_host();
      const CrbmParameters got = stack.layers[layer].to_host();
      CHECK(got.shape == want.shape);
      CHECK(got.W == want.W);
      CHECK(got.B == want.B);
      CHECK(got.visible_mean == want.visible_mean);
    };
    check(0, data, kGaussian, settings.gaussian);
    check(1, up_pass(stack.layers[0], data), kBinary, settings.binary);
  });
}

TEST_CASE("equal layers are as many and as large as the settings say, RBMs without history") {
  MachineSettings settings;
  settings.layers = 3;
  settings.hidden = 7;
  settings.order = 2;
  for (const bool history : {true, false}) {
    const std::vector<mcdbn::LayerSize> layers = equal_layers(settings, history);
    REQUIRE(layers.size() == 3);
    for (const mcdbn::LayerSize& layer : layers) {
      CHECK(layer.hidden == 7);
      CHECK(layer.order == (history ? 2 : 0));
    }
  }
}

TEST_CASE("fitting an RBM raises its exact likelihood, and progress ends at one") {
  on_every_device([](Device& device) {
    // Two patterns and a little noise.
    MatrixF rows(200, 6);
    for (Eigen::Index r = 0; r < rows.rows(); ++r)
      for (Eigen::Index c = 0; c < 6; ++c) rows(r, c) = (c < 3) == (r % 2 == 0) ? 1.0F : 0.0F;
    for (Eigen::Index r = 0; r < rows.rows(); r += 7) rows(r, r % 6) = 1.0F - rows(r, r % 6);
    MachineSettings settings = small_settings();
    settings.binary.rate = 0.1;
    settings.binary.epochs = 60;
    std::vector<double> progress;
    std::vector<std::string> stages;
    const auto observer = [&](const EpochReport& report) {
      progress.push_back(report.overall_progress);
      stages.push_back(report.stage);
    };
    const Cdbn rbm = fit_stack(device, Sequences::from_host(device, {rows}), kBinary, {{4, 0}},
                               settings, observer);
    CHECK(progress.size() == 60);
    CHECK(progress.back() == 1.0);
    CHECK(stages.front() == "layer.0");
    const reference::CrbmBatch batch{rows.cast<double>(), MatrixD(rows.rows(), 0)};
    const double fitted = reference::log_likelihood(in_double(rbm.layers[0].to_host()), batch);
    CHECK(fitted > -2.6);   // independent even units have −6·log 2 = −4.16
    CHECK(fitted < -0.69);  // no model of two patterns does better than log ½
    MachineSettings two = small_settings();
    progress.clear();
    fit_stack(device, clips(device, 3), kGaussian, {{4, 1}, {4, 1}}, two, observer);
    CHECK(progress.size() == 5);
    CHECK(std::is_sorted(progress.begin(), progress.end()));
    CHECK(progress.back() == 1.0);
    CHECK(stages.back() == "layer.1");
  });
}

TEST_CASE("an MRBM is fitted to three modalities, one of them Gaussian, in any order of names") {
  on_every_device([](Device& device) {
    // One bit, seen by all three.
    MatrixF left(80, 3), values(80, 2), right(80, 4);
    for (Eigen::Index r = 0; r < 80; ++r) {
      const float bit = r % 2 == 0 ? 1.0F : 0.0F;
      left.row(r).setConstant(bit);
      right.row(r).setConstant(1.0F - bit);
      values.row(r).setConstant(2.0F * bit - 1.0F);
    }
    std::vector<Sequences> data;
    for (const MatrixF* one : {&left, &values, &right})
      data.push_back(Sequences::from_host(device, {*one}));
    MachineSettings settings = small_settings();
    settings.mrbm.epochs = 60;
    settings.mrbm.rate = 0.02;
    std::size_t epochs = 0;
    double last = 0, loss = 0;
    const Mrbm mrbm = fit_mrbm(
        device, {{.name = "left"}, {.name = "value", .kind = kGaussian}, {.name = "right"}}, data,
        settings, [&](const EpochReport& report) {
          ++epochs;
          last = report.overall_progress;
          loss = report.loss;
        });
    CHECK(epochs == 60);
    CHECK(last == 1.0);
    CHECK(loss < 0.3);
    CHECK(mrbm.shape().modalities[1].visible == 2);
    CHECK(mrbm.shape().modalities[2].name == "right");
    CHECK(mrbm.hidden() == 4);
    // Each is inferred from the one that is given.
    const Matrix inferred_values(device, 80, 2), inferred_right(device, 80, 4);
    mrbm.infer({data[0].values, inferred_values, inferred_right}, {true, false, false}, 10);
    CHECK((inferred_right.to_host() - right).cwiseAbs().maxCoeff() < 0.3F);
    CHECK((inferred_values.to_host() - values).cwiseAbs().maxCoeff() < 0.6F);
    std::vector<Sequences> uneven = data;
    uneven[1] = clips(device, 2);
    CHECK_THROWS_AS(fit_mrbm(device, mrbm.shape().modalities, uneven, settings), ShapeError);
    CHECK_THROWS_AS(fit_mrbm(device, {{.name = "left"}}, data, settings), ShapeError);
  });
}

TEST_CASE("fit: too short data and settings out of range are refused") {
  on_every_device([](Device& device) {
    const Sequences data = clips(device, 3);
    CHECK_THROWS_AS(fit_stack(device, data, kGaussian, {{4, 30}}, small_settings()), ShapeError);
    MachineSettings settings = small_settings();
    settings.binary.rate = 0;
    CHECK_THROWS_AS(fit_stack(device, data, kBinary, {{4, 0}}, settings), ConfigError);
  });
}

TEST_CASE("fit: layers of impossible sizes are refused, by number") {
  on_every_device([](Device& device) {
    const Sequences data = clips(device, 3);
    const auto fit = [&](const std::vector<mcdbn::LayerSize>& layers) {
      fit_stack(device, data, kGaussian, layers, small_settings());
    };
    CHECK_THROWS_WITH_AS(fit({{4, 0}, {0, 0}}),
                         "`hidden` of layer 1 must be at least 1 and at most 100000, not 0",
                         ConfigError);
    CHECK_THROWS_WITH_AS(fit({{100'001, 0}}),
                         "`hidden` of layer 0 must be at least 1 and at most 100000, not 100001",
                         ConfigError);
    CHECK_THROWS_AS(fit({{4, 1001}}), ConfigError);
    CHECK_THROWS_AS(fit(std::vector<mcdbn::LayerSize>(65, {1, 0})), ConfigError);
    CHECK_THROWS_AS(fit({}), ShapeError);
  });
}

TEST_CASE("fit: values that the units cannot take are refused before anything is learnt") {
  on_every_device([](Device& device) {
    int epochs = 0;
    const auto observer = [&](const EpochReport&) { ++epochs; };
    const auto fit = [&](const MatrixF& odd, VisibleKind kind) {
      const MatrixF even = MatrixF::Constant(20, 3, 0.5F);
      fit_stack(device, Sequences::from_host(device, {even, odd}), kind, {{4, 0}}, small_settings(),
                observer);
    };
    const auto fit_both = [&](const MatrixF& odd, VisibleKind kind) {
      const std::vector<Sequences> data{
          Sequences::from_host(device, {MatrixF::Constant(20, 2, 0.5F)}),
          Sequences::from_host(device, {odd})};
      fit_mrbm(device, {{.name = "left"}, {.name = "right", .kind = kind}}, data, small_settings(),
               observer);
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                    kInfinite = std::numeric_limits<float>::infinity();
    for (const float value : {kNan, kInfinite, -kInfinite, 1.25F, -0.25F}) {
      CAPTURE(value);
      MatrixF odd = MatrixF::Constant(20, 3, 0.5F);
      odd(6, 1) = value;
      CHECK_THROWS_AS(fit(odd, kBinary), InputError);
      CHECK_THROWS_AS(fit_both(odd, kBinary), InputError);
      if (std::isfinite(value)) continue;
      CHECK_THROWS_AS(fit(odd, kGaussian), InputError);
      CHECK_THROWS_AS(fit_both(odd, kGaussian), InputError);
    }
    CHECK(epochs == 0);
    MatrixF ends = MatrixF::Zero(20, 3);
    ends.col(1).setOnes();
    CHECK_NOTHROW(fit(ends, kBinary));
    ends(6, 1) = 1.25F;
    CHECK_THROWS_WITH_AS(fit(ends, kBinary),
                         "layer.0: row 27, column 2 is 1.25; binary units need values from 0 to 1 "
                         "(Gaussian units take any)",
                         InputError);
    CHECK_THROWS_WITH_AS(fit_both(ends, kBinary),
                         "right: row 7, column 2 is 1.25; binary units need values from 0 to 1 "
                         "(Gaussian units take any)",
                         InputError);
    CHECK_NOTHROW(fit(ends, kGaussian));
  });
}

}  // namespace machine_fit_test
