#include "learning/contrastive_divergence.hpp"

#include <doctest/doctest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>

#include "device/every_device.hpp"
#include "device/fitting_tiles.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/base/errors.hpp"

namespace fused_contrastive_divergence_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

struct Case {
  CrbmShape shape;
  std::size_t batch, gibbs_steps;
};

/// Sizes, orders and both kinds of units that contrastive_divergence_test.cpp does not have; every
/// one is compiled for itself. The second has more rows than a panel of gradients takes at a time,
/// the last ones' A and B see histories of their own.
const std::vector<Case> kCases = {{{13, 17, 0, kBinary}, 29, 5},
                                  {{33, 31, 5, kBinary}, 131, 1},
                                  {{11, 19, 4, kBinary, 4, 2}, 9, 2},
                                  {{19, 5, 4, kGaussian, 0, 3}, 10, 2}};

CdRule rule_of(std::size_t gibbs_steps) {
  CdRule rule;
  rule.gibbs_steps = gibbs_steps;
  rule.W = rule.B = {0.05F, 0.9F, 0.01F};
  rule.A = {0.01F, 0.9F, 0.01F};
  return rule;
}

/// Frames, windows into them, and a model to start from; all of the same numbers every time.
struct Problem {
  explicit Problem(const Case& test) : test(test) {
    const std::size_t visible = test.shape.visible, hidden = test.shape.hidden,
                      order = test.shape.order;
    frames = random_matrix(order + 40, visible, 11);
    if (test.shape.kind == kBinary) frames = (0.5F * (frames.array() + 1.0F)).matrix();
    for (std::size_t i = 0; i < 2 * test.batch; ++i)
      index.push_back(static_cast<std::int32_t>(order + (7 * i + 3) % 40));
    start = CrbmParameters::zeros(test.shape);
    auto fill = [seed = 20U](MatrixF& m, double inputs) mutable {
      m = random_matrix(static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols()),
                        seed++, static_cast<float>(4.0 / (4.0 + inputs)));
    };
    fill(start.W, static_cast<double>(hidden + visible));
    fill(start.A, static_cast<double>(order * visible));
    fill(start.B, static_cast<double>(order * visible));
    fill(start.a, 8.0);
    fill(start.b, 8.0);
  }

  reference::CrbmBatch batch(std::size_t number) const {
    const std::size_t visible = test.shape.visible, order = test.shape.order;
    reference::CrbmBatch result{MatrixD(test.batch, visible), MatrixD(test.batch, order * visible)};
    for (std::size_t r = 0; r < test.batch; ++r) {
      const auto row = static_cast<Eigen::Index>(r);
      const std::int32_t at = index[number * test.batch + r];
      result.visible.row(row) = frames.row(at).cast<double>();
      for (std::size_t q = 0; q < order; ++q)
        result.history.block(row, static_cast<Eigen::Index>(q * visible), 1,
                             static_cast<Eigen::Index>(visible)) =
            frames.row(at - static_cast<std::int32_t>(order - q)).cast<double>();
    }
    return result;
  }

  Case test;
  MatrixF frames;
  std::vector<std::int32_t> index;
  CrbmParameters start;
};

RandomKey key_of(std::size_t batch_number) {
  return {42, static_cast<std::uint32_t>(batch_number), 3, 0};
}

MatrixD uniforms(RandomKey key, int gibbs_step, std::size_t rows, std::size_t columns) {
  key.phase = static_cast<std::uint16_t>(gibbs_step);
  MatrixD u(rows, columns);
  for (Eigen::Index r = 0; r < u.rows(); ++r)
    for (Eigen::Index c = 0; c < u.cols(); ++c)
      u(r, c) = random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return u;
}

struct ClearDraws {
  RandomKey key;
  reference::BoundedCdStep want;
};

/// The reference's mini-batch with the first seed for which every draw is further from its
/// probability than rounding can move that: then the device has to draw the same.
ClearDraws clear_draws(const Case& test, const CrbmParameters& model,
                       const reference::BoundedCrbm& velocities, const reference::CrbmBatch& batch,
                       std::size_t number) {
  const CdRule rule = rule_of(test.gibbs_steps);
  for (RandomKey key = key_of(number); key.seed < 1000; ++key.seed) {
    const auto draws = [&](int gibbs_step) {
      return uniforms(key, gibbs_step, test.batch, test.shape.hidden);
    };
    auto want = reference::bounded_cd_step(reference::BoundedCrbm::exact(in_double(model)),
                                           velocities, batch, static_cast<int>(test.gibbs_steps),
                                           draws, rule.W, rule.A, rule.B);
    if (want.uncertain_draws == 0.0) return {key, std::move(want)};
  }
  throw std::runtime_error("every seed has a draw too close to its probability");
}

/// Two mini-batches in a row, so that the momentum counts, each from the device's own parameters.
void check_against_reference(Device& device, const Case& test, std::optional<RowTile> tile) {
  const Problem problem(test);
  const Matrix frames = Matrix::from_host(device, problem.frames);
  const IndexBuffer index(device, problem.index);
  mcdbn::Crbm crbm(device, problem.start);
  ContrastiveDivergence cd(crbm, test.batch, tile);
  LossAccumulator losses(device, 1, test.batch);

  auto velocities = reference::BoundedCrbm::zeros_like(in_double(problem.start));
  for (std::size_t number = 0; number < 2; ++number) {
    CAPTURE(number);
    const auto [key, want] =
        clear_draws(test, crbm.to_host(), velocities, problem.batch(number), number);
    cd.step(Rows::indexed(frames, index, number * test.batch, test.batch),
            rule_of(test.gibbs_steps), key, losses);
    const CrbmParameters got = crbm.to_host();
    check_within(got, want.parameters);
    CHECK(crbm.W_transposed.to_host() == got.W.transpose());
    check_within("loss", losses.read_and_reset()[0], want.loss);
    velocities = want.velocities;
  }
  for (const Matrix* matrix : {&crbm.W, &crbm.A, &crbm.B, &crbm.a, &crbm.b, &crbm.W_transposed})
    if (!matrix->empty()) CHECK(padding_is_zero(*matrix));
}

struct TrainedBits {
  CrbmParameters parameters;
  bool operator==(const TrainedBits& other) const {
    const CrbmParameters &x = parameters, &y = other.parameters;
    return x.W == y.W && x.A == y.A && x.B == y.B && x.a == y.a && x.b == y.b;
  }
};

TrainedBits train_two(Device& device, const Case& test, std::optional<RowTile> tile,
                      std::uint64_t seed = 42) {
  const Problem problem(test);
  const Matrix frames = Matrix::from_host(device, problem.frames);
  const IndexBuffer index(device, problem.index);
  mcdbn::Crbm crbm(device, problem.start);
  ContrastiveDivergence cd(crbm, test.batch, tile);
  LossAccumulator losses(device, 1, test.batch);
  for (std::size_t number = 0; number < 2; ++number) {
    RandomKey key = key_of(number);
    key.seed = seed;
    cd.step(Rows::indexed(frames, index, number * test.batch, test.batch),
            rule_of(test.gibbs_steps), key, losses);
  }
  return {crbm.to_host()};
}

const Case kOddCase{{17, 33, 5, kGaussian}, 11, 5};

}  // namespace

TEST_CASE("one CD mini-batch, fused and composed, is the double reference's within rounding") {
  on_every_device([](Device& device) {
    for (const Case& test : kCases) {
      CAPTURE(test.shape.visible);
      CAPTURE(test.shape.hidden);
      CAPTURE(test.shape.order);
      const auto tile = choose_chain_tile(device, test.shape, test.batch);
      REQUIRE(tile);
      check_against_reference(device, test, tile);
      check_against_reference(device, test, std::nullopt);
    }
  });
}

TEST_CASE("every tile of the fused kernels gives the same bits") {
  on_every_device([](Device& device) {
    const auto chosen = choose_chain_tile(device, kOddCase.shape, kOddCase.batch);
    REQUIRE(chosen);
    const TrainedBits want = train_two(device, kOddCase, *chosen);
    for (const RowTile& tile : fitting_tiles(device, {{16, 7, 2, 1, 8, 3},
                                                      {8, 14, 1, 1, 4, 1},
                                                      {4, 4, 1, 32, 4, 2},
                                                      {1, 3, 1, 64, 16, 4}})) {
      CAPTURE(tile.vector_width);
      CAPTURE(tile.rows);
      CAPTURE(tile.group);
      check_against_reference(device, kOddCase, tile);
      CHECK(train_two(device, kOddCase, tile) == want);
    }
  });
}

// On oclgrind's device too, which watches barriers: more rows than a panel takes at a time, more
// columns than a panel has tiles, work-items that share both.
TEST_CASE("small: work-items that share panels of gradients wait for each other") {
  const Case test{{3, 9, 3, kGaussian}, 130, 1};
  on_every_device([&](Device& device) {
    const TrainedBits want = train_two(device, test, RowTile{16, 10, 1, 1, 8, 2});
    for (const RowTile& tile : fitting_tiles(device, {{4, 10, 1, 4, 4, 1}, {1, 8, 1, 8, 4, 2}})) {
      CAPTURE(tile.group);
      CHECK(train_two(device, test, tile) == want);
    }
  });
}

TEST_CASE("every candidate of the tuner gives the same bits") {
  on_every_device([](Device& device) {
    const Tuning usual = device.tuning();
    const TrainedBits want = train_two(device, kOddCase, RowTile{});
    for (const Tuning& tuning : tuning_candidates(device.info(), default_tuning(device.info()))) {
      CAPTURE(tuning.vector_width);
      CAPTURE(tuning.largest_rows);
      CAPTURE(tuning.accumulators);
      device.set_tuning(tuning);
      const auto tile = choose_chain_tile(device, kOddCase.shape, kOddCase.batch);
      check_against_reference(device, kOddCase, tile);
      CHECK(train_two(device, kOddCase, tile) == want);
    }
    device.set_tuning(usual);
  });
}

TEST_CASE("same seed, same bits; another seed, others") {
  on_every_device([](Device& device) {
    const auto tile = choose_chain_tile(device, kOddCase.shape, kOddCase.batch);
    for (const auto& form : {tile, std::optional<RowTile>()}) {
      const TrainedBits first = train_two(device, kOddCase, form);
      CHECK(train_two(device, kOddCase, form) == first);
      CHECK_FALSE(train_two(device, kOddCase, form, 43) == first);
    }
  });
}

TEST_CASE("a mini-batch is two launches") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const Matrix frames = Matrix::from_host(device, problem.frames);
    const IndexBuffer index(device, problem.index);
    mcdbn::Crbm crbm(device, problem.start);
    ContrastiveDivergence cd(crbm, kOddCase.batch);
    LossAccumulator losses(device, 1, kOddCase.batch);
    const auto before = device.launch_count();
    cd.step(Rows::indexed(frames, index, 0, kOddCase.batch), rule_of(5), key_of(0), losses);
    CHECK(device.launch_count() - before == 2);
  });
}

TEST_CASE("a layer that does not fit local memory falls back, and reports it at debug level") {
  on_every_device([](Device& device) {
    const std::size_t hidden = device.info().local_memory_bytes / sizeof(float) + 1;
    const Case test{{1, hidden, 0, kBinary}, 2, 1};
    std::ostringstream messages;
    const auto usual = spdlog::default_logger();
    const auto logger = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_st>(messages));
    logger->set_level(spdlog::level::debug);
    spdlog::set_default_logger(logger);
    const Problem problem(test);
    mcdbn::Crbm crbm(device, problem.start);
    ContrastiveDivergence cd(crbm, test.batch);
    spdlog::set_default_logger(usual);
    CHECK(messages.str().find("composed kernels instead") != std::string::npos);
    CHECK_FALSE(cd.tile());
    const Matrix frames = Matrix::from_host(device, problem.frames);
    const IndexBuffer index(device, problem.index);
    LossAccumulator losses(device, 1, test.batch);
    cd.step(Rows::indexed(frames, index, 0, test.batch), rule_of(1), key_of(0), losses);
    const MatrixF W = crbm.to_host().W;
    CHECK(W.allFinite());
    CHECK(W != problem.start.W);
  });
}

TEST_CASE("CD refuses what it cannot do") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const Matrix frames = Matrix::from_host(device, problem.frames);
    const IndexBuffer index(device, problem.index);
    mcdbn::Crbm crbm(device, problem.start);
    ContrastiveDivergence cd(crbm, 5);
    LossAccumulator losses(device, 1, 32);
    const auto step = [&](const Rows& rows, std::size_t gibbs_steps) {
      cd.step(rows, rule_of(gibbs_steps), key_of(0), losses);
    };
    CHECK_THROWS_AS(step(Rows::indexed(frames, index, 0, 22), 1), ShapeError);
    CHECK_THROWS_AS(step(Rows::indexed(frames, index, 0, 5), 0), ShapeError);
    CHECK_THROWS_AS(step(Rows(frames, 5, 5), 1), ShapeError);
  });
}

}  // namespace fused_contrastive_divergence_test
