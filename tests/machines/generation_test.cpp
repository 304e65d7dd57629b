// Algorithm 4, frame by frame against double precision with draws of its own.

#include "mcdbn/machines/generation.hpp"

#include <doctest/doctest.h>

#include "base/capture_bound.hpp"
#include "device/every_device.hpp"
#include "machines/drawn_frames.hpp"
#include "machines/free_run.hpp"
#include "machines/generation_reference.hpp"
#include "machines/random_crbm.hpp"
#include "mcdbn/base/errors.hpp"

namespace generation_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

CrbmParameters layer(const CrbmShape& shape, unsigned seed) {
  return random_crbm(shape, seed, 2.0F);
}

using Stack = std::vector<CrbmParameters>;

Cdbn on(Device& device, const Stack& layers) {
  Cdbn cdbn;
  for (const CrbmParameters& p : layers) cdbn.layers.emplace_back(device, p);
  return cdbn;
}

/// Of other lengths, the shortest of which is just enough for the stacks below.
std::vector<MatrixF> seeds_for(const Stack& layers, std::size_t count) {
  std::vector<MatrixF> seeds;
  for (std::size_t i = 0; i < count; ++i)
    seeds.push_back(random_matrix(9 + i, layers[0].shape.visible, static_cast<unsigned>(70 + i)));
  return seeds;
}

GenerationOptions options_with(std::size_t gibbs_steps, double temperature) {
  GenerationOptions options;
  options.frames = 7;
  options.samples = 2;
  options.gibbs_steps = gibbs_steps;
  options.temperature = temperature;
  options.seed = 0x5EED00000003ULL;  // more than 32 bits
  return options;
}

/// Its units deviate otherwise than by 1.
CrbmParameters with_deviation(CrbmParameters p) {
  p.visible_deviation = (1.5F + random_matrix(1, p.shape.visible, 3, 0.7F).array()).matrix();
  return p;
}

/// Of one to three layers, orders that differ, none among them, also of A and B, more sequences
/// than a block has rows. As many units throughout as would hide an exchange of layers.
std::vector<Stack> stacks() {
  return {
      {layer({1, 1, 1, kGaussian}, 1)},
      {layer({7, 13, 5, kGaussian}, 10)},
      {layer({6, 5, 2, kBinary}, 20)},
      {layer({6, 6, 0, kGaussian}, 30)},
      {with_deviation(layer({6, 5, 3, kGaussian, 3, 1}, 33))},
      {with_deviation(layer({6, 5, 2, kGaussian, 0, 2}, 36)), layer({5, 5, 3, kBinary, 3, 0}, 38)},
      {layer({19, 6, 2, kGaussian}, 40), layer({6, 7, 4, kBinary}, 50)},
      {layer({6, 6, 3, kGaussian}, 60), layer({6, 5, 0, kBinary}, 70)},
      {layer({5, 6, 3, kGaussian}, 80), layer({6, 6, 1, kBinary}, 90),
       layer({6, 17, 2, kBinary}, 100)}};
}

/// The sequences of a layer, begun; what is to be generated is NaN.
Matrix begun(Device& device, const std::vector<MatrixF>& starts, std::size_t frames) {
  const Eigen::Index history = starts[0].rows(), all = history + static_cast<Eigen::Index>(frames);
  MatrixF rows = MatrixF::Constant(static_cast<Eigen::Index>(starts.size()) * all, starts[0].cols(),
                                   std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < starts.size(); ++i)
    rows.middleRows(static_cast<Eigen::Index>(i) * all, history) = starts[i];
  return Matrix::from_host(device, rows);
}

}  // namespace

TEST_CASE("generation: every frame is Algorithm 4's with the same draws") {
  on_every_device([](Device& device) {
    for (const Stack& stack : stacks()) {
      const auto seeds = seeds_for(stack, stack.size() == 1 ? 6 : 2);
      for (const auto& [steps, temperature] :
           {std::pair<std::size_t, double>{1, 1.0}, {3, 1.0}, {2, 0.4}, {0, 1.0}, {2, 0.0}}) {
        INFO(stack.size(), " layers, ", stack[0].shape.visible, " visible");
        CAPTURE_BOUND(steps);
        CAPTURE_BOUND(temperature);
        const GenerationOptions options = options_with(steps, temperature);
        CHECK(check_drawn(generate(on(device, stack), seeds, options),
                          reference::generated(stack, seeds, options)) > 0.9);
      }
    }
  });
}

TEST_CASE("generation: frame by frame gives what one launch gives") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : {CrbmShape{7, 13, 5, kGaussian}, CrbmShape{33, 19, 1, kBinary}}) {
      const CrbmParameters p = layer(shape, 5);
      const Crbm crbm(device, p);
      const std::size_t history = 5, sequences = 11;
      std::vector<MatrixF> starts;
      for (unsigned i = 0; i < sequences; ++i)
        starts.push_back(random_matrix(history, shape.visible, 40 + i));
      for (const double temperature : {1.0, 0.7, 0.0}) {
        CAPTURE(temperature);
        GenerationOptions options = options_with(2, temperature);
        options.samples = 1;
        const auto run = [&](bool fused) {
          const Matrix state = begun(device, starts, options.frames);
          const auto before = device.launch_count();
          run_freely(crbm, state, sequences, history, options, fused);
          const auto launches = device.launch_count() - before;
          CHECK((fused ? launches == 1 : launches > options.frames));
          CHECK(padding_is_zero(state));
          return state.to_host();
        };
        const auto generated_rows = [&](const MatrixF& all) {
          std::vector<MatrixF> rows;
          const auto frames = static_cast<Eigen::Index>(options.frames);
          for (std::size_t i = 0; i < sequences; ++i) {
            const Eigen::Index at = static_cast<Eigen::Index>(i * (history + options.frames));
            CHECK(all.middleRows(at, history) == starts[i]);
            rows.emplace_back(all.middleRows(at + history, frames));
          }
          return rows;
        };
        const MatrixF fused = run(true), composed = run(false);
        const auto want = reference::generated({p}, starts, options);
        CHECK(check_drawn(generated_rows(fused), want) > 0.9);
        CHECK(check_drawn(generated_rows(composed), want) > 0.9);
        // At temperature 1 the composed form's draws are bits but for rounding.
        if (temperature != 1.0 && device.tuning().clblast_from == 0) CHECK(fused == composed);
      }
    }
  });
}

TEST_CASE("small: generation of one layer and of two, same seed, same bits; another seed, others") {
  on_every_device([](Device& device) {
    for (const Stack& stack :
         {Stack{layer({3, 5, 2, kGaussian}, 1)},
          Stack{layer({3, 5, 1, kGaussian}, 10), layer({5, 4, 2, kBinary}, 20)}}) {
      const Cdbn cdbn = on(device, stack);
      const auto seeds = seeds_for(stack, 1);
      GenerationOptions options = options_with(2, 1.0);
      options.frames = 4;
      options.samples = 3;
      const auto first = generate(cdbn, seeds, options);
      CHECK(check_drawn(first, reference::generated(stack, seeds, options)) > 0.8);
      CHECK(generate(cdbn, seeds, options) == first);
      CHECK(first[0] != first[1]);
      CHECK(first[1] != first[2]);
      options.seed = 4;
      CHECK(generate(cdbn, seeds, options) != first);
      options.temperature = 0;
      const auto means = generate(cdbn, seeds, options);
      CHECK(means[0] == means[1]);
      options.seed = 5;
      CHECK(generate(cdbn, seeds, options) == means);
    }
  });
}

TEST_CASE("small: work-items that share a block of sequences generate the same bits") {
  on_every_device([](Device& device) {
    const Stack stack{layer({7, 5, 2, kGaussian}, 1)};
    const Cdbn cdbn = on(device, stack);
    const auto seeds = seeds_for(stack, 3);
    const GenerationOptions options = options_with(2, 1.0);
    const auto want = generate(cdbn, seeds, options);
    const Tuning usual = device.tuning();
    device.set_tuning({.vector_width = 4, .largest_rows = 3, .accumulators = 4, .group = 4});
    CHECK(generate(cdbn, seeds, options) == want);
    device.set_tuning(usual);
  });
}

TEST_CASE("generation: no more of a seed counts than its history, and it is needed whole") {
  on_every_device([](Device& device) {
    for (const Stack& stack : stacks()) {
      const Cdbn cdbn = on(device, stack);
      std::size_t orders = 0;
      for (const CrbmParameters& p : stack) orders += p.shape.order;
      const std::size_t frames = seed_frames(cdbn);
      CHECK(frames == orders + (stack.back().shape.order == 0 ? 1 : 0));
      const MatrixF seed = random_matrix(frames, stack[0].shape.visible, 9);
      MatrixF longer = random_matrix(frames + 3, stack[0].shape.visible, 8);
      longer.bottomRows(static_cast<Eigen::Index>(frames)) = seed;
      const GenerationOptions options = options_with(1, 0.4);
      const auto want = generate(cdbn, {seed}, options);
      CHECK(generate(cdbn, {longer}, options) == want);
      MatrixF changed = seed;
      changed.row(0).array() += 0.5F;
      CHECK(generate(cdbn, {changed}, options) != want);
      CHECK_THROWS_AS(
          generate(cdbn, {seed.bottomRows(static_cast<Eigen::Index>(frames) - 1)}, options),
          ShapeError);
      CHECK_THROWS_AS(generate(cdbn, {MatrixF(frames, seed.cols() + 1)}, options), ShapeError);
    }
  });
}

TEST_CASE("generation: nothing asked for is nothing made, and what cannot be is refused") {
  on_every_device([](Device& device) {
    const Stack stack{layer({3, 5, 2, kGaussian}, 1)};
    const Cdbn cdbn = on(device, stack);
    const auto seeds = seeds_for(stack, 2);
    GenerationOptions options;
    CHECK(options.frames == 300);
    CHECK(options.samples == 1);
    CHECK(options.temperature == 1.0);
    CHECK(options.gibbs_steps == 30);
    CHECK(options.seed == 1);
    CHECK(generate(cdbn, {}, options).empty());
    options.samples = 0;
    CHECK(generate(cdbn, seeds, options).empty());
    options.samples = 2;
    options.frames = 0;
    const auto none = generate(cdbn, seeds, options);
    CHECK(none.size() == 4);
    CHECK(none[3].rows() == 0);
    CHECK_THROWS_AS(generate(Cdbn{}, seeds, options), ShapeError);
    const Matrix state(device, 12, 3);
    CHECK_THROWS_AS(run_freely(cdbn.layers[0], state, 2, 1, options), ShapeError);  // order 2
    CHECK_THROWS_AS(run_freely(cdbn.layers[0], state, 5, 2, options), ShapeError);  // 12 rows
    CHECK_THROWS_AS(run_freely(cdbn.layers[0], Matrix(device, 12, 4), 2, 2, options), ShapeError);
  });
}

}  // namespace generation_test
