// A CDBN whose layers have widths and orders of their own.

#include <doctest/doctest.h>

#include "learning/greedy_scene.hpp"
#include "mcdbn/base/errors.hpp"

namespace cdbn_layers_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::uint16_t kFirstStream = 20;

/// A and B of the first layer see histories of their own; the second has none.
const std::vector<CrbmShape> kLayers = {{5, 7, 3, VisibleKind::gaussian, 1, 3},
                                        {7, 4, 0, VisibleKind::binary},
                                        {4, 6, 2, VisibleKind::binary, 2, 0}};

reference::GreedyMachine trained_on_host(const std::vector<MatrixF>& clips,
                                         const std::vector<CrbmParameters>& start,
                                         const reference::GreedyPlan& plan, double& closest_draw) {
  reference::GreedyCode code{in_double(clips), 0};
  reference::GreedyMachine machine;
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    const auto run =
        reference::train_layer(plan, i == 0 ? plan.gaussian : plan.binary, code,
                               in_double(start[i]), static_cast<int>(kFirstStream + i));
    closest_draw = std::min(closest_draw, run.closest_draw);
    machine.pose.push_back(run.machine.pose.front());
    code = up_pass(machine.pose.back().crbm, code);
  }
  return machine;
}

}  // namespace

TEST_CASE("a CDBN with a width and orders for each layer is the double reference's") {
  const std::vector<MatrixF> clips = tiny_clips(5, 710);
  const LearningSettings settings = settings_of(tiny_plan());
  std::vector<CrbmParameters> start;
  for (const CrbmShape& shape : kLayers)
    start.push_back(
        CrbmParameters::random(shape, 0.4, {3, static_cast<std::uint32_t>(start.size())}));
  double closest_draw = 1;
  const auto want = trained_on_host(clips, start, tiny_plan(), closest_draw);
  REQUIRE(closest_draw > kClosestDraw);
  on_every_device([&](Device& device) {
    Cdbn first;
    for (const CrbmParameters& p : start) first.layers.emplace_back(device, p);
    std::vector<double> progress;
    const EpochObserver observer = [&](const EpochReport& report) {
      CHECK(report.stage.starts_with("deep."));
      progress.push_back(report.overall_progress);
    };
    const TrainedCdbn got = train_cdbn(device, Sequences::from_host(device, clips), kLayers,
                                       settings, kFirstStream, observer, "deep", &first);
    REQUIRE(got.cdbn.layers.size() == kLayers.size());
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
      CAPTURE(i);
      const CrbmParameters p = got.cdbn.layers[i].to_host();
      CHECK(p.shape == kLayers[i]);
      const auto check = [](const MatrixF& x, const MatrixD& y) {
        CHECK(reference::misfit(x, y, MatrixD::Constant(y.rows(), y.cols(), kGreedyTolerance)) ==
              "");
      };
      const reference::Crbm& crbm = want.pose[i].crbm;
      check(p.W, crbm.weights);
      check(p.A, crbm.visible_history);
      check(p.B, crbm.hidden_history);
      check(p.a, crbm.visible_bias);
      check(p.b, crbm.hidden_bias);
    }
    CHECK(got.code.valid_from == 5);
    CHECK(got.code.values.columns() == 6);
    CHECK(std::is_sorted(progress.begin(), progress.end()));
    CHECK(progress.size() == settings.gaussian.epochs + 2 * settings.binary.epochs);
    CHECK(progress.back() == doctest::Approx(1.0));
  });
}

TEST_CASE("a CDBN whose layers do not fit each other is refused") {
  on_every_device([](Device& device) {
    CHECK_THROWS_AS(train_cdbn(device, Sequences::from_host(device, tiny_clips(5, 700)),
                               {{5, 3, 1, VisibleKind::gaussian}, {4, 2, 0, VisibleKind::binary}},
                               settings_of(tiny_plan())),
                    ShapeError);
  });
}

TEST_CASE("the settings make every layer of a CDBN as wide and with as long a history") {
  LearningSettings settings;
  settings.hidden = 9;
  settings.order = 3;
  settings.layers = 3;
  CHECK(layer_shapes(4, settings) == std::vector<CrbmShape>{{4, 9, 3, VisibleKind::gaussian},
                                                            {9, 9, 3, VisibleKind::binary},
                                                            {9, 9, 3, VisibleKind::binary}});
}

}  // namespace cdbn_layers_test
