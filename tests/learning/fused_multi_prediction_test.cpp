#include "learning/multi_prediction.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/fitting_tiles.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/base/errors.hpp"

namespace fused_multi_prediction_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Case {
  std::size_t track, pose, hidden, batch, steps;
};

// The second one is taken in three parts, whose stacks are added up in several pieces.
const std::vector<Case> kCases = {{33, 17, 21, 11, 10}, {9, 5, 7, 217, 15}};
const Case kOddCase{17, 33, 19, 29, 3};
// Two parts; the pieces of the stacks end within them.
const Case kLongCase{5, 3, 7, 141, 16};

struct Problem {
  explicit Problem(const Case& test)
      : test(test),
        start(MrbmParameters::zeros(two_modalities(test.track, test.pose, test.hidden))) {
    const std::array<std::size_t, 2> visible{test.track, test.pose};
    for (std::size_t m = 0; m < 2; ++m) {
      const auto seed = static_cast<unsigned>(10 * m);
      frames[m] = (0.5F * (random_matrix(50, visible[m], seed + 1).array() + 1.0F)).matrix();
      start.W[m] = random_matrix(visible[m], test.hidden, seed + 2,
                                 4.0F / (4.0F + static_cast<float>(test.hidden)));
      start.a[m] = random_matrix(1, visible[m], seed + 3, 0.5F);
    }
    start.b = random_matrix(1, test.hidden, 30, 0.5F);
    for (std::size_t i = 0; i < test.batch; ++i)
      index.push_back(static_cast<std::int32_t>((7 * i + 3) % 45));
  }

  /// The track's codes are read `kShift` frames later, as a look-ahead does.
  MatrixD batch(std::size_t modality) const {
    MatrixD codes(test.batch, frames[modality].cols());
    for (Eigen::Index r = 0; r < codes.rows(); ++r)
      codes.row(r) = frames[modality]
                         .row(index[static_cast<std::size_t>(r)] + (modality == 0 ? kShift : 0))
                         .cast<double>();
    return codes;
  }

  static constexpr int kShift = 4;
  Case test;
  std::array<MatrixF, 2> frames;
  MrbmParameters start;
  std::vector<std::int32_t> index;
};

bool same_bits(const MrbmParameters& x, const MrbmParameters& y) {
  return x.W == y.W && x.a == y.a && x.b == y.b;
}

struct Step {
  MrbmParameters gradients, after;
  std::vector<float> losses;
  std::uint64_t launches = 0;
};

Step run_step(Device& device, const Problem& problem, const std::optional<RowTile>& tile,
              const UpdateRule& rule, int count = 1) {
  const Matrix track = Matrix::from_host(device, problem.frames[0]);
  const Matrix pose = Matrix::from_host(device, problem.frames[1]);
  const IndexBuffer index(device, problem.index);
  Mrbm mrbm(device, problem.start);
  const std::size_t batch = problem.test.batch;
  const MrbmSettings settings{.mean_field_steps = problem.test.steps};
  Mrbm still(device, problem.start);
  MultiPrediction gradient(still, batch, settings, tile, OptimizerKind::none);
  MultiPrediction multi_prediction(mrbm, batch, settings, tile);
  LossAccumulator losses(device, 2, batch);
  const Rows track_rows = Rows::indexed(track, index, 0, batch, Problem::kShift);
  const Rows pose_rows = Rows::indexed(pose, index, 0, batch);
  gradient.step({track_rows, pose_rows}, rule, losses);
  CHECK(same_bits(still.to_host(), problem.start));
  losses.read_and_reset();
  const auto before = device.launch_count();
  for (int i = 0; i < count; ++i) multi_prediction.step({track_rows, pose_rows}, rule, losses);
  Step step{gradient.gradients(), mrbm.to_host(), losses.read_and_reset(),
            device.launch_count() - before};
  for (std::size_t m = 0; m < 2; ++m) {
    CHECK(mrbm.W_transposed[m].to_host() == step.after.W[m].transpose());
    for (const Matrix* matrix : {&mrbm.W[m], &mrbm.W_transposed[m], &mrbm.a[m]})
      CHECK(padding_is_zero(*matrix));
  }
  return step;
}

std::optional<RowTile> tile_for(Device& device, const Case& test) {
  const CrbmShape shape{std::max(test.track, test.pose), test.hidden, 0, VisibleKind::binary};
  return choose_chain_tile(device, shape, test.batch);
}

void check_against_reference(Device& device, const Case& test, const std::optional<RowTile>& tile) {
  const Problem problem(test);
  const auto model = reference::BoundedMrbm::exact(in_double(problem.start));
  const auto want = reference::bounded_multi_prediction(model, {problem.batch(0), problem.batch(1)},
                                                        static_cast<int>(test.steps));
  UpdateRule rule = UpdateRule::adam();
  rule.weight_decay = 0.01F;
  const Step got = run_step(device, problem, tile, rule);
  check_within(got.gradients, want.gradient);
  check_within("loss of the track", got.losses[0], want.losses[0]);
  check_within("loss of the pose", got.losses[1], want.losses[1]);
  // Adam's first step by the device's own gradients, from moments of zero.
  const MrbmParameters& gradients = got.gradients;
  reference::BoundedMrbm after = model, mean = reference::BoundedMrbm::zeros_like(model),
                         square = mean;
  reference::bounded_adam_update(after, mean, square,
                                 reference::BoundedMrbm::exact(in_double(gradients)), rule, 1);
  check_within(got.after, after);
}

}  // namespace

TEST_CASE("multi-prediction's gradients, fused and composed, are the double reference's") {
  on_every_device([](Device& device) {
    for (const Case& test : kCases) {
      CAPTURE(test.track);
      CAPTURE(test.hidden);
      const auto tile = tile_for(device, test);
      REQUIRE(tile);
      check_against_reference(device, test, tile);
      check_against_reference(device, test, std::nullopt);
    }
  });
}

TEST_CASE("every tile of fused multi-prediction gives the same bits, and so does another run") {
  on_every_device([](Device& device) {
    for (const Case& test : {kOddCase, kLongCase}) {
      const Problem problem(test);
      const Step want = run_step(device, problem, tile_for(device, test), UpdateRule::adam(), 3);
      for (const RowTile& tile : fitting_tiles(
               device, {{16, 7, 2, 1, 8, 3}, {4, 4, 1, 32, 4, 2}, {1, 3, 1, 64, 16, 4}})) {
        CAPTURE(test.batch);
        CAPTURE(tile.vector_width);
        CAPTURE(tile.rows);
        check_against_reference(device, test, tile);
        const Step got = run_step(device, problem, tile, UpdateRule::adam(), 3);
        CHECK(same_bits(got.after, want.after));
        // Three mini-batches: of each part one gathers and two work, the last updates. A GPU takes
        // a mini-batch whole.
        const std::size_t parts = test.batch > 100 && !device.info().is_gpu ? 2 : 1;
        CHECK(got.launches == 3 * (3 * parts + 1));
      }
    }
  });
}

TEST_CASE("a GPU takes a mini-batch of multi-prediction whole, and its gradients are right") {
  on_every_device([](Device& device) {
    Device gpu = as_gpu(device);
    const auto tile = tile_for(gpu, kLongCase);
    REQUIRE(tile);
    check_against_reference(gpu, kLongCase, tile);
    CHECK(run_step(gpu, Problem(kLongCase), tile, UpdateRule::adam()).launches == 4);
  });
}

// On oclgrind's device too: two parts, work-items that share blocks and panels, and the biases'
// sums.
TEST_CASE("small: work-items that share fused multi-prediction wait for each other") {
  const Problem problem({2, 3, 3, 103, 2});
  on_every_device([&](Device& device) {
    const Step want = run_step(device, problem, RowTile{16, 10, 1, 1, 8, 2}, UpdateRule::adam());
    for (const RowTile& tile : fitting_tiles(device, {{4, 10, 1, 4, 4, 1}, {1, 8, 1, 8, 4, 2}})) {
      CAPTURE(tile.group);
      CHECK(same_bits(run_step(device, problem, tile, UpdateRule::adam()).after, want.after));
    }
  });
}

TEST_CASE("multi-prediction refuses what it cannot do") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const Matrix track = Matrix::from_host(device, problem.frames[0]);
    const Matrix pose = Matrix::from_host(device, problem.frames[1]);
    const IndexBuffer index(device, problem.index);
    Mrbm mrbm(device, problem.start);
    CHECK_THROWS_AS(MultiPrediction(mrbm, 5, {.mean_field_steps = 0}), ConfigError);
    MultiPrediction multi_prediction(mrbm, 5, {.mean_field_steps = 2});
    LossAccumulator losses(device, 2, 8);
    const auto step = [&](const Rows& x, const Rows& y) {
      multi_prediction.step({x, y}, UpdateRule::adam(), losses);
    };
    const Rows five = Rows::indexed(track, index, 0, 5), six = Rows::indexed(pose, index, 0, 6);
    CHECK_THROWS_AS(step(five, six), ShapeError);
    CHECK_THROWS_AS(step(Rows::indexed(track, index, 0, 6), six), ShapeError);
    CHECK_THROWS_AS(step(Rows(track, 0, 5), Rows(pose, 0, 5)), ShapeError);
  });
}

}  // namespace fused_multi_prediction_test
