// The joint likelihood, fused and composed, against double precision with its own draws and against
// enumeration.
#include "learning/joint_likelihood.hpp"

#include "base/capture_bound.hpp"
#include "device/every_device.hpp"
#include "device/fitting_tiles.hpp"
#include "device/training_state.hpp"
#include "learning/mrbm_rules_scene.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/crbm_enumeration.hpp"

namespace joint_likelihood_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Of more than a vector, a tile and a block, and whole in none.
const Scene& odd() {
  static const Scene scene({{17, kBinary}, {33, kGaussian}, {5, kBinary}}, 19, 131, 0.2F);
  return scene;
}

/// Fused with what suits the device, and composed.
std::vector<std::optional<RowTile>> both_ways(Mrbm& mrbm, std::size_t batch) {
  const auto suiting = JointLikelihood(mrbm, batch, {}).tile();
  REQUIRE(suiting);
  return {suiting, std::nullopt};
}
const std::vector<RowTile> kOtherTiles = {{4, 4, 1, 32, 4, 2}, {8, 3, 2, 1, 16, 3}};

/// The joint likelihood's gradient and losses with each of these tiles.
void check_joint_likelihood(const Scene& scene, const MrbmSettings& settings,
                            const std::vector<RowTile>& more = {}) {
  ReferenceChain chain(scene, settings);
  chain.start(kKey);
  chain.run_all(kKey);
  const reference::BoundedMrbm want = chain.gradient();
  for (const reference::Bounded& weights : want.weights) CHECK(weights.bound.maxCoeff() < 1e-4);
  on_every_device([&](Device& device) {
    Mrbm mrbm(device, scene.start);
    auto tiles = both_ways(mrbm, scene.rows());
    for (const RowTile& tile : fitting_tiles(device, more)) tiles.emplace_back(tile);
    for (const auto& tile : tiles) {
      CAPTURE(tile.has_value());
      JointLikelihood rule(mrbm, scene.rows(), tile, settings, OptimizerKind::none);
      const auto losses = run(device, scene, rule, 1);
      check_within(rule.gradients(), want);
      for (std::size_t m = 0; m < losses.size(); ++m)
        check_within("loss", losses[m], chain.loss(m));
    }
  });
}

/// Adam's moments and momentum's velocity of a machine that has learnt nothing yet.
reference::BoundedMrbm no_moments(const Scene& scene) {
  return reference::BoundedMrbm::zeros_like(reference::BoundedMrbm::exact(scene.model));
}

}  // namespace

TEST_CASE("small: the joint likelihood's gradient is contrastive divergence over all modalities") {
  for (const Scene* scene : {&two(), &three()})
    for (const auto& [k, sampled] : {std::pair{1U, false}, {3U, false}, {2U, true}}) {
      CAPTURE_BOUND(k);
      CAPTURE_BOUND(sampled);
      check_joint_likelihood(*scene, {.gibbs_steps = k, .sample_visible = sampled});
    }
}

TEST_CASE("small: work-items that share a block of the joint likelihood wait for each other") {
  check_joint_likelihood(three(), {.gibbs_steps = 2, .sample_visible = true}, {{4, 3, 1, 4, 4, 1}});
}

TEST_CASE("the joint likelihood's gradient is the reference's with every tile, for odd sizes") {
  check_joint_likelihood(odd(), {.gibbs_steps = 2, .sample_visible = true}, kOtherTiles);
}

TEST_CASE(
    "small: persistent chains of the joint likelihood go on where the last mini-batch ended") {
  // One step a mini-batch: after two with the same draws, chains often are where they would have
  // been from another start.
  const MrbmSettings settings{.gibbs_steps = 1, .persistent = true};
  ReferenceChain chain(two(), settings);
  chain.start(kKey);
  chain.run_all(kKey, true);
  const reference::Bounded particles = chain.sample;
  RandomKey next = kKey;
  ++next.step;
  chain.start(next);
  chain.sample = particles;
  chain.run_all(next, true);
  const reference::BoundedMrbm want = chain.gradient();
  on_every_device([&](Device& device) {
    Mrbm mrbm(device, two().start);
    for (const auto& tile : both_ways(mrbm, 7)) {
      CAPTURE(tile.has_value());
      JointLikelihood rule(mrbm, 7, tile, settings, OptimizerKind::none);
      run(device, two(), rule, 2);
      check_within(rule.gradients(), want);
    }
  });
}

TEST_CASE("every tile of the fused joint likelihood gives the same bits, by two launches") {
  on_every_device([](Device& device) {
    const MrbmSettings settings{
        .rate = 0.01, .gibbs_steps = 2, .persistent = true, .sample_visible = true};
    std::optional<MrbmParameters> want;
    Mrbm any(device, odd().start);
    std::vector<RowTile> tiles = fitting_tiles(device, kOtherTiles);
    tiles.push_back(both_ways(any, odd().rows())[0].value());
    for (const RowTile& tile : tiles) {
      CAPTURE(tile.vector_width);
      Mrbm mrbm(device, odd().start);
      JointLikelihood rule(mrbm, odd().rows(), tile, settings);
      const auto before = device.launch_count();
      run(device, odd(), rule, 3);
      CHECK(device.launch_count() - before == 3 * (2 + 2));  // three modalities: two gathers
      const MrbmParameters got = mrbm.to_host();
      for (std::size_t m = 0; m < got.W.size(); ++m) {
        CHECK(mrbm.W_transposed[m].to_host() == got.W[m].transpose());
        for (const Matrix* matrix : {&mrbm.W[m], &mrbm.W_transposed[m], &mrbm.a[m]})
          CHECK(padding_is_zero(*matrix));
      }
      if (!want) want = got;
      CHECK(got.W == want->W);
      CHECK(got.a == want->a);
      CHECK(got.b == want->b);
    }
  });
}

TEST_CASE("small: chains of a checkpoint of the joint likelihood go on in blocks of other rows") {
  const MrbmSettings settings{.rate = 0.01, .gibbs_steps = 2, .persistent = true};
  on_every_device([&](Device& device) {
    Mrbm undisturbed(device, two().start);
    JointLikelihood whole(undisturbed, 7, RowTile{.vector_width = 4, .rows = 3, .update_rows = 4},
                          settings);
    run(device, two(), whole, 1);
    TrainingState::Content content;
    TrainingState saving = TrainingState::saving(content);
    whole.visit_state(saving);
    const MrbmParameters after_one = undisturbed.to_host();
    run(device, two(), whole, 1);
    Mrbm mrbm(device, after_one);
    JointLikelihood resumed(mrbm, 7, RowTile{.vector_width = 4, .rows = 2, .update_rows = 4},
                            settings);
    TrainingState restoring = TrainingState::restoring(content);
    resumed.visit_state(restoring);
    run(device, two(), resumed, 1);
    CHECK(mrbm.to_host().W == undisturbed.to_host().W);
    CHECK(mrbm.to_host().b == undisturbed.to_host().b);
  });
}

TEST_CASE("the joint likelihood moves by Adam's first step, fused and composed") {
  on_every_device([](Device& device) {
    Mrbm still(device, odd().start);
    for (const auto& tile : both_ways(still, odd().rows())) {
      CAPTURE(tile.has_value());
      const MrbmSettings settings{.rate = 0.01, .weight_decay = 0.1};
      JointLikelihood gradient(still, odd().rows(), tile, settings, OptimizerKind::none);
      run(device, odd(), gradient);
      Mrbm moved(device, odd().start);
      JointLikelihood rule(moved, odd().rows(), tile, settings);
      run(device, odd(), rule);
      auto want = reference::BoundedMrbm::exact(odd().model);
      auto mean = no_moments(odd()), square = mean;
      const auto by = reference::BoundedMrbm::exact(in_double(gradient.gradients()));
      bounded_adam_update(want, mean, square, by, UpdateRule::adam(0.01F, 0.1F), 1);
      check_within(moved.to_host(), want);
    }
  });
}

// More rows than a panel of gradients takes at a time: sums wait among the gradients, while the
// velocities wait beside them.
TEST_CASE("the joint likelihood's momentum, of many rows, is the double reference's") {
  const MrbmSettings settings{.rate = 0.05, .weight_decay = 0.1, .adam = false, .momentum = 0.8};
  REQUIRE(odd().rows() > kUpdateChunk);
  auto want = reference::BoundedMrbm::exact(odd().model);
  auto velocity = no_moments(odd());
  const UpdateRule by{.rate = 0.05F, .momentum = 0.8F, .weight_decay = 0.1F};
  RandomKey key = kKey;
  for (int step = 0; step < 2; ++step, ++key.step) {
    ReferenceChain chain(odd(), settings, want);
    chain.start(key);
    chain.run_all(key);
    bounded_momentum_update(want, velocity, chain.gradient(), by);
  }
  on_every_device([&](Device& device) {
    Mrbm any(device, odd().start);
    auto tiles = both_ways(any, odd().rows());
    tiles.insert(tiles.end(), kOtherTiles.begin(), kOtherTiles.end());
    for (const auto& tile : tiles) {
      CAPTURE(tile.has_value());
      Mrbm mrbm(device, odd().start);
      JointLikelihood rule(mrbm, odd().rows(), tile, settings);
      run(device, odd(), rule, 2);
      check_within(mrbm.to_host(), want);
    }
  });
}

TEST_CASE("the joint likelihood is composed where a row of all modalities does not fit") {
  on_every_device([](Device& device) {
    const std::size_t half = device.info().local_memory_bytes / sizeof(float) / 2;
    const auto fits = [&](std::size_t each) {
      Mrbm mrbm(device, MrbmParameters::zeros({{{"x", each}, {"y", each}}, 3}));
      return JointLikelihood(mrbm, 2, {}).tile().has_value();
    };
    CHECK(fits(half - 32));
    CHECK_FALSE(fits(half));
  });
}

TEST_CASE("the joint likelihood refuses codes that it was not made for, fused and composed") {
  on_every_device([](Device& device) {
    Mrbm mrbm(device, two().start);
    const Matrix four(device, 9, 4), three(device, 9, 3);
    const IndexBuffer index(device, {0, 1, 2, 3, 4, 5, 6, 7});
    LossAccumulator losses(device, 2, 8);
    for (const auto& tile : both_ways(mrbm, 7)) {
      JointLikelihood rule(mrbm, 7, tile, {});
      const auto learn = [&](const std::vector<Rows>& rows) {
        rule.learn(rows, LearningStep{1, 0.0, kKey}, losses);
      };
      const auto of = [&](const Matrix& matrix, std::size_t count) {
        return Rows::indexed(matrix, index, 0, count);
      };
      CHECK_NOTHROW(learn({of(four, 7), of(three, 7)}));
      CHECK_THROWS_AS(learn({of(four, 8), of(three, 8)}), ShapeError);
      CHECK_THROWS_AS(learn({of(three, 7), of(three, 7)}), ShapeError);
      CHECK_THROWS_AS(learn({Rows(four, 0, 7), Rows(three, 0, 7)}), ShapeError);
      CHECK_THROWS_AS(learn({of(four, 7)}), ShapeError);
    }
  });
}

TEST_CASE("the joint likelihood's long chains follow the exact gradient of the whole machine") {
  constexpr std::size_t kCopies = 400;
  const Scene few({{3, kBinary}, {2, kBinary}}, 3, 5, 1.2F);
  Scene many = few;
  for (MatrixF& code : many.codes) code = MatrixF(code.replicate(kCopies, 1).eval());
  reference::Crbm whole;
  whole.visible_units = reference::VisibleUnits::binary;
  whole.weights.resize(5, 3);
  whole.weights << few.model.weights[0], few.model.weights[1];
  whole.visible_bias.resize(5);
  whole.visible_bias << few.model.visible_bias[0], few.model.visible_bias[1];
  whole.hidden_bias = few.model.hidden_bias;
  whole.visible_history = MatrixD::Zero(0, 5);
  whole.hidden_history = MatrixD::Zero(0, 3);
  MatrixD cases(5, 5);
  cases << few.codes[0].cast<double>(), few.codes[1].cast<double>();
  const reference::Crbm exact = reference::exact_gradient(whole, {cases, MatrixD::Zero(5, 0)});
  on_every_device([&](Device& device) {
    Mrbm mrbm(device, many.start);
    JointLikelihood rule(mrbm, many.rows(), {.gibbs_steps = 40, .sample_visible = true},
                         OptimizerKind::none);
    run(device, many, rule);
    const MrbmParameters got = rule.gradients();
    MatrixD weights(5, 3);
    weights << got.W[0].cast<double>(), got.W[1].cast<double>();
    // The gradient descends. Means of 2,000 rows: an error of some 0.01 a weight.
    CHECK((weights + exact.weights).cwiseAbs().maxCoeff() < 0.05);
    CHECK(exact.weights.cwiseAbs().maxCoeff() > 0.1);
  });
}

}  // namespace joint_likelihood_test
