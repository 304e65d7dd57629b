#include "learning/contrastive_divergence.hpp"

#include <doctest/doctest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/crbm_reference.hpp"
#include "reference/error_bounds.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using reference::gamma_n;
using reference::kRoundoff;
using reference::kSigmoidError;
using reference::misfit;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

struct Case {
  CrbmShape shape;
  std::size_t batch, gibbs_steps;
};

/// Sizes, orders and both kinds of units that contrastive_divergence_test.cpp does not have; every
/// one is compiled for itself.
const std::vector<Case> kCases = {{{13, 17, 0, kBinary}, 29, 5}, {{33, 31, 5, kBinary}, 103, 1}};

CdRule rule_of(std::size_t gibbs_steps) {
  CdRule rule;
  rule.gibbs_steps = gibbs_steps;
  rule.W = rule.B = {0.05F, 0.9F, 0.01F};
  rule.A = {0.01F, 0.9F, 0.01F};
  return rule;
}

reference::Crbm model_of(const CrbmParameters& p) {
  return {p.shape.kind == kGaussian ? reference::VisibleUnits::gaussian
                                    : reference::VisibleUnits::binary,
          p.W.cast<double>(),
          p.A.cast<double>(),
          p.B.cast<double>(),
          p.a.cast<double>(),
          p.b.cast<double>()};
}

/// Frames, windows into them, and a model to start from; all of the same numbers every time.
struct Problem {
  explicit Problem(const Case& test) : test(test) {
    const auto [visible, hidden, order, kind] = test.shape;
    frames = random_matrix(order + 40, visible, 11);
    if (kind == kBinary) frames = (0.5F * (frames.array() + 1.0F)).matrix();
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
    const auto [visible, hidden, order, kind] = test.shape;
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

MatrixD magnitude(const MatrixD& x) {
  return x.cwiseAbs();
}

/// What rounding may do to a mini-batch whose draws come out as the reference's.
struct CdBound {
  MatrixD hidden;  ///< of any p(h), which is what a draw's distance from p must exceed
  reference::Crbm gradient;
  double loss = 0;
};

CdBound bound_of(const reference::Crbm& model, const reference::CrbmBatch& batch,
                 const reference::CdResult& cd) {
  const double n = static_cast<double>(batch.visible.rows());
  const double visible_units = static_cast<double>(batch.visible.cols());
  const double hidden_units = static_cast<double>(cd.hidden.cols());
  const double past = static_cast<double>(batch.history.cols());
  const bool gaussian = model.visible_units == reference::VisibleUnits::gaussian;
  const MatrixD history = magnitude(batch.history), W = magnitude(model.weights);
  // Sums of products with a bias, one rounding a term (Higham 3.5); two if stored in between.
  const MatrixD bias_v = (history * magnitude(model.visible_history)).rowwise() +
                         RowVectorD(model.visible_bias.cwiseAbs());
  const MatrixD bias_h = (history * magnitude(model.hidden_history)).rowwise() +
                         RowVectorD(model.hidden_bias.cwiseAbs());
  // σ' ≤ ¼; hidden units that are on are 1, so that nothing carries over from step to step.
  const MatrixD ones = MatrixD::Ones(batch.visible.rows(), cd.hidden.cols());
  MatrixD visible = gamma_n(past + hidden_units + 4.0) * (bias_v + ones * W.transpose());
  if (!gaussian)
    visible = 0.25 * visible + kSigmoidError * kRoundoff * magnitude(cd.reconstruction);
  const MatrixD reach = magnitude(cd.reconstruction).cwiseMax(magnitude(batch.visible)) + visible;
  CdBound bound;
  bound.hidden = 0.25 * (gamma_n(past + visible_units + 4.0) * (bias_h + reach * W) + visible * W) +
                 kSigmoidError * kRoundoff * ones;

  const MatrixD data = magnitude(batch.visible), end = magnitude(cd.reconstruction);
  const MatrixD change_v = visible + kRoundoff * (data + end);
  const MatrixD change_h = 2.0 * bound.hidden + 2.0 * kRoundoff * ones;
  const double sums = gamma_n(2.0 * n + 4.0);
  const auto mean_product = [&](const MatrixD& x, const MatrixD& y) {
    return MatrixD(x.transpose() * y / n);
  };
  bound.gradient = model;
  bound.gradient.weights = sums * (mean_product(data, cd.hidden) + mean_product(reach, ones)) +
                           mean_product(data, bound.hidden) + mean_product(visible, ones) +
                           mean_product(reach, bound.hidden);
  bound.gradient.visible_history = mean_product(history, change_v + sums * (data + reach));
  bound.gradient.hidden_history = mean_product(history, change_h + sums * 2.0 * ones);
  bound.gradient.visible_bias = (change_v + sums * (data + reach)).colwise().mean();
  bound.gradient.hidden_bias = (change_h + sums * 2.0 * ones).colwise().mean();
  const MatrixD error = magnitude(batch.visible - cd.reconstruction);
  bound.loss = ((2.0 * error + change_v).cwiseProduct(change_v).sum() +
                gamma_n(visible_units + n + 4.0) * (error + change_v).squaredNorm()) /
               (n * visible_units);
  return bound;
}

struct ClearDraws {
  RandomKey key;
  reference::CdResult want;
  CdBound bound;
};

/// The reference's mini-batch with the first seed for which every draw is further from its
/// probability than rounding can move that: then the device has to draw the same.
ClearDraws clear_draws(const Case& test, const reference::Crbm& model,
                       const reference::CrbmBatch& batch, std::size_t number) {
  for (RandomKey key = key_of(number); key.seed < 1000; ++key.seed) {
    auto want = reference::contrastive_divergence(
        model, batch, static_cast<int>(test.gibbs_steps),
        [&](int gibbs_step) { return uniforms(key, gibbs_step, test.batch, test.shape.hidden); });
    CdBound bound = bound_of(model, batch, want);
    if (want.closest_draw > bound.hidden.maxCoeff()) return {key, std::move(want), bound};
  }
  throw std::runtime_error("every seed has a draw too close to its probability");
}

/// Checks one parameter after an update; `velocity_bound` goes in as that of the old velocity and
/// comes out as that of the new one.
void check_parameter(const char* name, const MatrixF& got, const MatrixD& before,
                     const MatrixD& want, const MatrixD& old_velocity, const MatrixD& gradient,
                     const MatrixD& gradient_bound, const UpdateRule& rule,
                     MatrixD& velocity_bound) {
  const MatrixD pull = magnitude(gradient) + gradient_bound + rule.weight_decay * magnitude(before);
  velocity_bound = rule.momentum * velocity_bound + rule.rate * gradient_bound +
                   gamma_n(5.0) * (rule.momentum * magnitude(old_velocity) + rule.rate * pull);
  const MatrixD bound = (1.0 + kRoundoff) * velocity_bound + kRoundoff * magnitude(want);
  INFO(std::string(name));
  CHECK(misfit(got, want, bound) == "");
}

/// Two mini-batches in a row, so that the momentum counts, each from the device's own parameters.
void check_against_reference(Device& device, const Case& test, std::optional<RowTile> tile) {
  const Problem problem(test);
  const CdRule rule = rule_of(test.gibbs_steps);
  UpdateRule bias_rule = rule.W;
  bias_rule.weight_decay = 0.0F;
  const Matrix frames = Matrix::from_host(device, problem.frames);
  const IndexBuffer index(device, problem.index);
  mcdbn::Crbm crbm(device, problem.start);
  ContrastiveDivergence cd(crbm, test.batch, tile);
  LossAccumulator losses(device, 1, test.batch);

  reference::Crbm velocity = model_of(CrbmParameters::zeros(test.shape));
  reference::Crbm velocity_bound = velocity;
  for (std::size_t number = 0; number < 2; ++number) {
    CAPTURE(number);
    const reference::Crbm before = model_of(crbm.to_host());
    const reference::CrbmBatch batch = problem.batch(number);
    const auto [key, want, bound] = clear_draws(test, before, batch, number);
    cd.step(Rows::indexed(frames, index, number * test.batch, test.batch), rule, key, losses);
    const CrbmParameters got = crbm.to_host();
    const reference::Crbm old_velocity = velocity;
    reference::Crbm after = before;
    reference::update(after, velocity, want.gradient, rule.W, rule.A, rule.B);
    const reference::Crbm &g = want.gradient, &e = bound.gradient, &v = old_velocity;
    check_parameter("W", got.W, before.weights, after.weights, v.weights, g.weights, e.weights,
                    rule.W, velocity_bound.weights);
    check_parameter("A", got.A, before.visible_history, after.visible_history, v.visible_history,
                    g.visible_history, e.visible_history, rule.A, velocity_bound.visible_history);
    check_parameter("B", got.B, before.hidden_history, after.hidden_history, v.hidden_history,
                    g.hidden_history, e.hidden_history, rule.B, velocity_bound.hidden_history);
    MatrixD bound_a = velocity_bound.visible_bias, bound_b = velocity_bound.hidden_bias;
    check_parameter("a", got.a, before.visible_bias, after.visible_bias, v.visible_bias,
                    g.visible_bias, e.visible_bias, bias_rule, bound_a);
    check_parameter("b", got.b, before.hidden_bias, after.hidden_bias, v.hidden_bias, g.hidden_bias,
                    e.hidden_bias, bias_rule, bound_b);
    velocity_bound.visible_bias = bound_a;
    velocity_bound.hidden_bias = bound_b;
    CHECK(crbm.W_transposed.to_host() == got.W.transpose());
    const double loss = (batch.visible - want.reconstruction).squaredNorm() /
                        static_cast<double>(test.batch * test.shape.visible);
    CHECK(std::abs(losses.read_and_reset()[0] - loss) <= bound.loss);
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
    for (const RowTile& tile : {RowTile{16, 7, 2, 1, 8}, RowTile{8, 14, 1, 1, 4},
                                RowTile{4, 4, 1, 32, 4}, RowTile{1, 3, 1, 64, 16}}) {
      CAPTURE(tile.vector_width);
      CAPTURE(tile.rows);
      CAPTURE(tile.group);
      check_against_reference(device, kOddCase, tile);
      CHECK(train_two(device, kOddCase, tile) == want);
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

TEST_CASE("a layer that does not fit local memory falls back, and says so at debug level") {
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
