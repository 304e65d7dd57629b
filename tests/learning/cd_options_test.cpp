// Contrastive divergence with each of its options, by the fused kernels and by one product after
// another, against the double reference with its own draws.

#include <doctest/doctest.h>

#include <cmath>

#include "device/every_device.hpp"
#include "device/training_state.hpp"
#include "learning/persistent_contrastive_divergence.hpp"
#include "learning/within_bounds.hpp"
#include "machines/cdbn_decoder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "reference/cd_options_reference.hpp"

namespace cd_options_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Four steps of parameters below 2 from sums of at most some twenty products: rounding adds a
/// hundred times 2^-24 at most, Adam's quotients ten times that. What any option does moves a
/// parameter by more than 1e-3.
constexpr double kTolerance = 1e-5;
constexpr std::size_t kSteps = 4, kBatch = 5, kFrames = 23;

struct Scene {
  Scene(const CrbmShape& shape, const CdSettings& settings, unsigned seed = 1)
      : shape(shape), settings(settings), start(CrbmParameters::zeros(shape)), seed(seed) {
    unsigned next = 10;
    for (const auto& [matrix, scale] : {std::pair{&start.W, 0.6F},
                                        {&start.A, 0.3F},
                                        {&start.B, 0.4F},
                                        {&start.a, 0.5F},
                                        {&start.b, 0.5F}})
      *matrix = random_matrix(static_cast<std::size_t>(matrix->rows()),
                              static_cast<std::size_t>(matrix->cols()), ++next, scale);
    frames = random_matrix(kFrames, shape.visible, 6, 1.5F);
    if (shape.kind == VisibleKind::binary)
      frames = ((frames.array() / 1.5F + 1.0F) / 2.0F).matrix();
    for (std::size_t i = 0; i < kSteps * kBatch; ++i)
      rows.push_back(
          static_cast<std::int32_t>(shape.order + (7 * i + 3) % (kFrames - shape.order)));
  }

  /// Every third number or so is unseen, some frames as a whole.
  void hide_some() {
    seen = MatrixF::Ones(frames.rows(), frames.cols());
    for (Eigen::Index t = 0; t < frames.rows(); ++t)
      for (Eigen::Index i = 0; i < frames.cols(); ++i)
        if ((5 * t + 3 * i) % 7 < 2 || t % 11 == 4) seen(t, i) = frames(t, i) = 0;
  }

  RandomKey key(std::size_t step) const { return {seed, static_cast<std::uint32_t>(step), 9, 0}; }

  reference::CrbmBatch batch(std::size_t step) const {
    const auto order = static_cast<Eigen::Index>(shape.order), visible = frames.cols();
    reference::CrbmBatch result{MatrixD(kBatch, visible), MatrixD(kBatch, order * visible)};
    for (std::size_t r = 0; r < kBatch; ++r) {
      const auto row = static_cast<Eigen::Index>(r);
      const Eigen::Index t = rows[step * kBatch + r];
      result.visible.row(row) = frames.row(t).cast<double>();
      if (seen.size() > 0) {
        result.seen.conservativeResize(row + 1, visible);
        result.seen.row(row) = seen.row(t).cast<double>();
      }
      for (Eigen::Index q = 0; q < order; ++q)
        result.history.block(row, q * visible, 1, visible) =
            frames.row(t - order + q).cast<double>();
    }
    return result;
  }

  reference::ChainDraws draws(std::size_t step) const {
    const auto numbers = [this, step](std::uint16_t phase, std::size_t columns, auto&& draw) {
      RandomKey own = key(step);
      own.phase = phase;
      MatrixD all(kBatch, columns);
      for (Eigen::Index r = 0; r < all.rows(); ++r)
        for (Eigen::Index c = 0; c < all.cols(); ++c)
          all(r, c) = draw(own, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
      return all;
    };
    return {[=, this](int k) {
              return numbers(static_cast<std::uint16_t>(k), shape.hidden, random_uniform);
            },
            [=, this](int k) {
              const auto phase = static_cast<std::uint16_t>(0x1000 + k);
              return shape.kind == VisibleKind::gaussian
                         ? numbers(phase, shape.visible, random_normal)
                         : numbers(phase, shape.visible, random_uniform);
            }};
  }

  CdRule rule(std::size_t step) const { return cd_rule_for(settings, 9, 0.2 * step); }

  reference::CdOptions options(std::size_t step) const {
    const CdRule chosen = rule(step);
    return {static_cast<int>(chosen.gibbs_steps),
            chosen.W,
            chosen.A,
            chosen.B,
            settings.adam,
            chosen.sample_visible,
            double{chosen.sparsity_target},
            double{chosen.sparsity_strength},
            settings.persistent,
            double{chosen.fast_rate},
            double{chosen.deviation_rate}};
  }

  CrbmShape shape;
  CdSettings settings;
  CrbmParameters start;
  MatrixF frames, seen;  ///< seen: empty where everything was
  std::vector<std::int32_t> rows;
  unsigned seed;
};

template <typename Rule>
void check(Device& device, const Scene& scene, bool fused) {
  const Matrix frames = Matrix::from_host(device, scene.frames);
  Matrix seen;
  if (scene.seen.size() > 0) seen = Matrix::from_host(device, scene.seen);
  const IndexBuffer index(device, scene.rows);
  Crbm crbm(device, scene.start);
  const auto tile = choose_chain_tile(device, scene.shape, kBatch);
  REQUIRE(tile);
  Rule trainer(crbm, kBatch, fused ? tile : std::nullopt, scene.settings);
  LossAccumulator losses(device, 1, kBatch);
  reference::CdTraining want(in_double(scene.start));
  for (std::size_t step = 0; step < kSteps; ++step) {
    CAPTURE(step);
    want.step(scene.batch(step), scene.options(step), scene.draws(step));
    REQUIRE(want.closest_draw > 5e-5);
    const auto before = device.launch_count();
    trainer.step(Rows::indexed(frames, index, step * kBatch, kBatch), scene.rule(step),
                 scene.key(step), losses, seen.empty() ? nullptr : &seen);
    if (trainer.tile())
      CHECK(device.launch_count() - before == (scene.settings.sparsity_strength > 0 ? 3 : 2));
    CHECK(std::abs(losses.read_and_reset().at(0) - want.loss) <= 10 * kTolerance);
    const CrbmParameters got = crbm.to_host();
    check_close("W", got.W, want.model.weights, kTolerance);
    check_close("A", got.A, want.model.visible_history, kTolerance);
    check_close("B", got.B, want.model.hidden_history, kTolerance);
    check_close("a", got.a, want.model.visible_bias, kTolerance);
    check_close("b", got.b, want.model.hidden_bias, kTolerance);
    check_close("deviation", got.visible_deviation, want.deviation, kTolerance);
    CHECK(crbm.W_transposed.to_host() == got.W.transpose());
    if constexpr (std::is_same_v<Rule, PersistentContrastiveDivergence>) {
      const MatrixF particles = trainer.particles().to_host().topRows(kBatch);
      CHECK((particles.cast<double>() - want.particles).cwiseAbs().maxCoeff() == 0);
    }
  }
  for (const Matrix* matrix :
       {&crbm.W, &crbm.A, &crbm.B, &crbm.a, &crbm.b, &crbm.W_transposed, &crbm.visible_deviation})
    if (!matrix->empty()) CHECK(padding_is_zero(*matrix));
}

/// Rates with which every option counts for something.
CdSettings settings() {
  return {.gibbs_steps = 2,
          .rate = 0.05,
          .rate_A = 0.02,
          .rate_B = 0.03,
          .momentum = 0.7,
          .weight_decay = 0.05};
}

const CrbmShape kGaussian{5, 6, 2, VisibleKind::gaussian}, kBinary{7, 4, 1, VisibleKind::binary};

template <typename Rule>
void check_everywhere(CdSettings changed, bool fused_too = true, unsigned seed = 1,
                      bool hide_some = false) {
  on_every_device([&](Device& device) {
    for (const CrbmShape& shape : {kGaussian, kBinary})
      for (const bool fused : {true, false}) {
        if (fused && !fused_too) continue;
        CAPTURE(shape.visible);
        CAPTURE(fused);
        Scene scene(shape, changed, seed);
        if (hide_some) scene.hide_some();
        check<Rule>(device, scene, fused);
      }
  });
}

}  // namespace

TEST_CASE("small: CD with drawn visible units is the double reference's with the same draws") {
  CdSettings changed = settings();
  changed.sample_visible = true;
  check_everywhere<ContrastiveDivergence>(changed);
}

TEST_CASE("small: a target for the hidden units' activity pulls as the double reference does") {
  CdSettings changed = settings();
  changed.sparsity_target = 0.2;
  changed.sparsity_strength = 0.5;
  check_everywhere<ContrastiveDivergence>(changed);
}

TEST_CASE("small: L1, Adam and falling rates are the double reference's") {
  CdSettings changed = settings();
  changed.l1 = 0.1;
  changed.final_rate = 0.3;
  check_everywhere<ContrastiveDivergence>(changed);
  changed.adam = true;
  changed.cosine = true;
  check_everywhere<ContrastiveDivergence>(changed);
}

TEST_CASE("small: persistent chains go on where they were, as the double reference's do") {
  CdSettings changed = settings();
  changed.persistent = true;
  check_everywhere<PersistentContrastiveDivergence>(changed);
  changed.sample_visible = true;
  changed.gibbs_steps = 1;
  changed.sparsity_strength = 0.3;
  check_everywhere<PersistentContrastiveDivergence>(changed);
}

TEST_CASE("small: persistent chains of a checkpoint go on in blocks of other rows") {
  const Scene scene({5, 6, 2, VisibleKind::gaussian}, settings());
  on_every_device([&](Device& device) {
    const Matrix frames = Matrix::from_host(device, scene.frames);
    const IndexBuffer index(device, scene.rows);
    LossAccumulator losses(device, 1, kBatch);
    const auto step = [&](PersistentContrastiveDivergence& trainer, std::size_t number) {
      trainer.step(Rows::indexed(frames, index, number * kBatch, kBatch), scene.rule(number),
                   scene.key(number), losses);
    };
    const RowTile tile{.vector_width = 4, .rows = 3, .update_rows = 4};
    Crbm undisturbed(device, scene.start);
    PersistentContrastiveDivergence whole(undisturbed, kBatch, tile, scene.settings);
    step(whole, 0);
    TrainingState::Content content;
    TrainingState saving = TrainingState::saving(content);
    whole.visit_state(saving);
    const CrbmParameters after_one = undisturbed.to_host();
    step(whole, 1);
    RowTile other = tile;
    other.rows = 2;
    for (const auto& resumed_tile : {std::optional(other), std::optional<RowTile>()}) {
      Crbm crbm(device, after_one);
      PersistentContrastiveDivergence resumed(crbm, kBatch, resumed_tile, scene.settings);
      TrainingState restoring = TrainingState::restoring(content);
      resumed.visit_state(restoring);
      step(resumed, 1);
      CHECK(resumed.particles().to_host().topRows(kBatch) ==
            whole.particles().to_host().topRows(kBatch));
      check_close("W", crbm.to_host().W, undisturbed.to_host().W.cast<double>(), kTolerance);
    }
  });
}

TEST_CASE("small: fast weights move the chains and no parameter, as the double reference's do") {
  CdSettings changed = settings();
  changed.persistent = true;
  changed.fast_rate = 0.2;
  check_everywhere<PersistentContrastiveDivergence>(changed, false);
}

TEST_CASE("small: unseen units stay at zero in every kind of chain, as in the reference") {
  CdSettings changed = settings();
  changed.sample_visible = true;
  check_everywhere<ContrastiveDivergence>(changed, true, 1, true);
  changed.persistent = true;
  check_everywhere<PersistentContrastiveDivergence>(changed, true, 1, true);
  changed.fast_rate = 0.2;
  check_everywhere<PersistentContrastiveDivergence>(changed, false, 1, true);
}

TEST_CASE("small: the deviation of Gaussian units is learnt as the double reference learns it") {
  CdSettings changed = settings();
  changed.deviation_rate = 0.2;
  on_every_device([&](Device& device) {
    check<ContrastiveDivergence>(device, Scene({5, 6, 0, VisibleKind::gaussian}, changed), true);
    for (const CrbmShape& shape : {kGaussian, CrbmShape{3, 2, 0, VisibleKind::binary}}) {
      CrbmParameters p = CrbmParameters::zeros(shape);
      Crbm without(device, p);
      CHECK(ContrastiveDivergence(without, kBatch, changed).tile());
      CHECK_FALSE(without.has_deviation);
      p.visible_deviation *= 2;
      Crbm given(device, p);
      CHECK_THROWS_AS(ContrastiveDivergence(given, kBatch), ConfigError);
    }
  });
}

TEST_CASE(
    "small: a layer divides frames by its deviation on the way up, and multiplies them down") {
  on_every_device([](Device& device) {
    const Scene scene({5, 6, 0, VisibleKind::gaussian}, settings());
    CrbmParameters p = scene.start;
    p.visible_deviation = (2.0F + random_matrix(1, 5, 77).array()).matrix();
    const Crbm plain(device, scene.start), scaled(device, p);
    MatrixF divided = scene.frames;
    divided.array().rowwise() /= p.visible_deviation.row(0).array();
    const MatrixF got =
        up_pass(scaled, Sequences::from_host(device, {scene.frames})).values.to_host();
    const MatrixF want = up_pass(plain, Sequences::from_host(device, {divided})).values.to_host();
    CHECK((got - want).cwiseAbs().maxCoeff() < 1e-6F);
    const Matrix code = Matrix::from_host(device, want);
    const auto decoded = [&](const Crbm& layer, bool fused) {
      const Cdbn cdbn{{layer}};
      CdbnDecoder decoder(cdbn, code, 1);
      decoder.decode(2, kFrames, {}, fused);
      return MatrixF(decoder.visible().to_host().bottomRows(kFrames - 2));
    };
    for (const bool fused : {true, false}) {
      MatrixF multiplied = decoded(plain, fused);
      multiplied.array().rowwise() *= p.visible_deviation.row(0).array();
      CHECK((decoded(scaled, fused) - multiplied).cwiseAbs().maxCoeff() < 1e-6F);
    }
  });
}

TEST_CASE("a layer is trained by the rule that its settings specify") {
  on_every_device([](Device& device) {
    const Scene scene(kBinary, settings());
    const auto trained = [&](bool persistent) {
      LearningSettings learning;
      learning.batch = 4;
      learning.least_batches = 3;
      CdSettings own = settings();
      own.epochs = 1;
      own.persistent = persistent;
      return train_crbm(device, Sequences::from_host(device, {scene.frames}), scene.start, own,
                        learning, 3)
          .to_host()
          .W;
    };
    CHECK(trained(true) == trained(true));
    CHECK(trained(true) != trained(false));
  });
}

TEST_CASE("the derivative of log p(v) by a deviation is the difference quotient") {
  // log p(v) = −F(v / σ) − Σ log σ − log Z: Z is that of the scaled units and does not move.
  Scene scene({3, 4, 0, VisibleKind::gaussian}, settings());
  const reference::Crbm model = in_double(scene.start);
  const reference::CrbmBatch batch = scene.batch(0);
  const auto likelihood = [&](const RowVectorD& log_deviation) {
    double sum = 0;
    for (Eigen::Index r = 0; r < batch.visible.rows(); ++r) {
      const RowVectorD u = batch.visible.row(r).array() / log_deviation.array().exp();
      const RowVectorD input = model.hidden_bias + u * model.weights;
      sum += (1.0 + input.array().exp()).log().sum() -
             0.5 * (u - model.visible_bias).squaredNorm() - log_deviation.sum();
    }
    return sum / static_cast<double>(batch.visible.rows());
  };
  reference::CdTraining training(model);
  reference::CdOptions options{1, {}, {}, {}};
  options.deviation_rate = 1;
  training.step(batch, options, scene.draws(0));
  for (Eigen::Index i = 0; i < 3; ++i) {
    RowVectorD up = RowVectorD::Zero(3), down = up;
    up(i) = 1e-5;
    down(i) = -1e-5;
    CHECK(std::log(training.deviation(i)) ==
          doctest::Approx((likelihood(up) - likelihood(down)) / 2e-5).epsilon(1e-7));
  }
}

}  // namespace cd_options_test
