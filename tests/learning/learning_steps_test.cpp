// Several steps of contrastive divergence and of multi-prediction in a row, by the fused kernels
// and by one product after another, with rules that differ from parameter to parameter and from
// step to step.

#include <doctest/doctest.h>

#include <cmath>

#include "device/every_device.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/multi_prediction.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/machines/sequences.hpp"
#include "reference/units_reference.hpp"
#include "reference/update_reference.hpp"

namespace learning_steps_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Six steps of parameters below 2 from sums of at most thirty products: rounding adds a hundred
/// times 2^-24 at most. Any rule that goes to another parameter or step moves one by 1e-3.
constexpr double kTolerance = 5e-6;
constexpr std::size_t kSteps = 6, kBatch = 4, kFrames = 20;

std::vector<std::int32_t> some_rows(std::size_t first) {
  std::vector<std::int32_t> rows;
  for (std::size_t i = 0; i < kSteps * kBatch; ++i)
    rows.push_back(static_cast<std::int32_t>(first + (7 * i + 3) % (kFrames - 2 * first)));
  return rows;
}

CdRule cd_rule(std::size_t step) {
  const float momentum = step < 2 ? 0.0F : 0.9F;
  CdRule rule;
  rule.gibbs_steps = 1 + step % 3;
  rule.W = {0.05F, momentum, 0.3F};
  rule.A = {0.02F, 0.7F * momentum, 0.9F};
  rule.B = {0.03F, 0.4F * momentum, 0.6F};
  return rule;
}

CrbmParameters made_up_crbm(const CrbmShape& shape) {
  CrbmParameters p = CrbmParameters::zeros(shape);
  const std::size_t history = shape.order * shape.visible;
  p.W = random_matrix(shape.visible, shape.hidden, 1, 0.7F);
  p.A = random_matrix(history, shape.visible, 2, 0.3F);
  p.B = random_matrix(history, shape.hidden, 3, 0.5F);
  p.a = random_matrix(1, shape.visible, 4);
  p.b = random_matrix(1, shape.hidden, 5);
  return p;
}

struct CdScene {
  explicit CdScene(const CrbmShape& shape, std::uint64_t seed)
      : shape(shape), seed(seed), rows(some_rows(shape.order)), start(made_up_crbm(shape)) {
    frames = random_matrix(kFrames, shape.visible, 6, 1.7F);
    if (shape.kind == VisibleKind::binary)
      frames = ((frames.array() / 1.7F + 1.0F) / 2.0F).matrix();
  }

  RandomKey key(std::size_t step) const { return {seed, static_cast<std::uint32_t>(step), 9, 0}; }

  reference::CrbmBatch batch(std::size_t step) const {
    const Eigen::Index visible = frames.cols();
    const auto order = static_cast<Eigen::Index>(shape.order);
    reference::CrbmBatch result{MatrixD(kBatch, visible), MatrixD(kBatch, order * visible)};
    for (std::size_t r = 0; r < kBatch; ++r) {
      const Eigen::Index t = rows[step * kBatch + r], row = static_cast<Eigen::Index>(r);
      result.visible.row(row) = frames.row(t).cast<double>();
      for (Eigen::Index q = 0; q < order; ++q)
        result.history.block(row, q * visible, 1, visible) =
            frames.row(t - order + q).cast<double>();
    }
    return result;
  }

  MatrixD draws(std::size_t step, int gibbs_step) const {
    RandomKey own = key(step);
    own.phase = static_cast<std::uint16_t>(gibbs_step);
    MatrixD uniform(kBatch, shape.hidden);
    for (Eigen::Index r = 0; r < uniform.rows(); ++r)
      for (Eigen::Index c = 0; c < uniform.cols(); ++c)
        uniform(r, c) =
            random_uniform(own, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
    return uniform;
  }

  CrbmShape shape;
  std::uint64_t seed;
  std::vector<std::int32_t> rows;
  CrbmParameters start;
  MatrixF frames;
};

struct CdWanted {
  reference::Crbm model;
  std::vector<double> losses;
  double closest_draw = 1;
};

CdWanted wanted(const CdScene& scene) {
  CdWanted want{in_double(scene.start), {}, 1};
  reference::Crbm velocity = in_double(CrbmParameters::zeros(scene.shape));
  for (std::size_t step = 0; step < kSteps; ++step) {
    const CdRule rule = cd_rule(step);
    const reference::CrbmBatch batch = scene.batch(step);
    const auto cd = reference::contrastive_divergence(
        want.model, batch, static_cast<int>(rule.gibbs_steps),
        [&](int gibbs_step) { return scene.draws(step, gibbs_step); });
    want.closest_draw = std::min(want.closest_draw, cd.closest_draw);
    want.losses.push_back((batch.visible - cd.reconstruction).squaredNorm() /
                          static_cast<double>(batch.visible.size()));
    reference::update(want.model, velocity, cd.gradient, rule.W, rule.A, rule.B);
  }
  return want;
}

void check_cd(Device& device, const CdScene& scene, const CdWanted& want,
              std::optional<RowTile> tile) {
  const Matrix frames = Matrix::from_host(device, scene.frames);
  const IndexBuffer index(device, scene.rows);
  Crbm crbm(device, scene.start);
  ContrastiveDivergence cd(crbm, kBatch + 3, tile);  // made for more than it gets
  LossAccumulator losses(device, 1, kBatch + 3);
  for (std::size_t step = 0; step < kSteps; ++step) {
    cd.step(Rows::indexed(frames, index, step * kBatch, kBatch), cd_rule(step), scene.key(step),
            losses);
    CHECK(std::abs(losses.read_and_reset().at(0) - want.losses[step]) <= 10 * kTolerance);
  }
  const CrbmParameters got = crbm.to_host();
  check_close("W", got.W, want.model.weights, kTolerance);
  check_close("A", got.A, want.model.visible_history, kTolerance);
  check_close("B", got.B, want.model.hidden_history, kTolerance);
  check_close("a", got.a, want.model.visible_bias, kTolerance);
  check_close("b", got.b, want.model.hidden_bias, kTolerance);
  CHECK(crbm.W_transposed.to_host() == got.W.transpose());
}

UpdateRule adam_rule(std::size_t step) {
  return {.rate = 0.05F / static_cast<float>(step + 1),
          .momentum = 0.8F,
          .weight_decay = 0.7F,
          .beta2 = 0.95F,
          .epsilon = 1e-3F};
}

constexpr int kLookAhead = 2, kMeanFieldSteps = 3;

struct MrbmScene {
  MrbmScene(std::size_t track, std::size_t pose, std::size_t hidden) {
    codes = {((random_matrix(kFrames, track, 1).array() + 1) / 2).matrix(),
             ((random_matrix(kFrames, pose, 2).array() + 1) / 2).matrix()};
    start = mrbm_of({random_matrix(track, hidden, 3), random_matrix(pose, hidden, 4)},
                    {random_matrix(1, track, 5), random_matrix(1, pose, 6)},
                    random_matrix(1, hidden, 7));
  }

  std::vector<MatrixD> batch(std::size_t step) const {
    std::vector<MatrixD> result(2);
    for (std::size_t m = 0; m < 2; ++m) {
      result[m].resize(kBatch, codes[m].cols());
      for (std::size_t r = 0; r < kBatch; ++r)
        result[m].row(static_cast<Eigen::Index>(r)) =
            codes[m].row(rows[step * kBatch + r] + (m == 0 ? kLookAhead : 0)).cast<double>();
    }
    return result;
  }

  std::array<MatrixF, 2> codes;
  MrbmParameters start;
  std::vector<std::int32_t> rows = some_rows(kLookAhead);
};

struct MrbmWanted {
  reference::Mrbm model;
  std::vector<std::array<double, 2>> losses;  ///< of the track, of the pose, each from the other
};

MrbmWanted wanted(const MrbmScene& scene) {
  MrbmWanted want{in_double(scene.start), {}};
  reference::Mrbm decaying =
      want.model.with_parameters(Eigen::VectorXd::Zero(want.model.flattened().size()));
  for (MatrixD& weights : decaying.weights) weights.setOnes();
  const MatrixD decays = decaying.flattened().transpose();
  MatrixD mean = 0 * decays, square = 0 * decays;
  for (std::size_t step = 0; step < kSteps; ++step) {
    const auto batch = scene.batch(step);
    std::array<double, 2> losses{};
    for (int present = 0; present < 2; ++present) {
      const auto trace = reference::mean_field(want.model, static_cast<std::size_t>(1 - present),
                                               batch, kMeanFieldSteps);
      losses[1 - present] =
          reference::cross_entropy_of_sigmoid(batch[1 - present], trace.missing_input) /
          static_cast<double>(batch[1 - present].size());
    }
    want.losses.push_back(losses);
    const MatrixD gradient = reference::multi_prediction(want.model, batch, kMeanFieldSteps)
                                 .gradient.flattened()
                                 .transpose();
    UpdateRule rule = adam_rule(step);
    MatrixD parameters = want.model.flattened().transpose();
    const MatrixD shrunk =
        double{rule.rate} * double{rule.weight_decay} * parameters.cwiseProduct(decays);
    rule.weight_decay = 0;
    reference::adam_update(parameters, mean, square, gradient, rule, static_cast<int>(step) + 1);
    want.model = want.model.with_parameters((parameters - shrunk).transpose());
  }
  return want;
}

void check_multi_prediction(const MrbmScene& scene, const MrbmWanted& want, Mrbm& mrbm,
                            MultiPrediction& trainer) {
  Device& device = mrbm.device();
  const Matrix track = Matrix::from_host(device, scene.codes[0]);
  const Matrix pose = Matrix::from_host(device, scene.codes[1]);
  const IndexBuffer index(device, scene.rows);
  LossAccumulator losses(device, 2, kBatch);
  for (std::size_t step = 0; step < kSteps; ++step) {
    trainer.step({Rows::indexed(track, index, step * kBatch, kBatch, kLookAhead),
                  Rows::indexed(pose, index, step * kBatch, kBatch)},
                 adam_rule(step), losses);
    const auto got = losses.read_and_reset();
    for (std::size_t direction = 0; direction < 2; ++direction)
      CHECK(std::abs(got.at(direction) - want.losses[step][direction]) <= 10 * kTolerance);
  }
  const MrbmParameters got = mrbm.to_host();
  for (std::size_t m = 0; m < 2; ++m) {
    check_close("W", got.W[m], want.model.weights[m], kTolerance);
    check_close("a", got.a[m], want.model.visible_bias[m], kTolerance);
    CHECK(mrbm.W_transposed[m].to_host() == got.W[m].transpose());
  }
  check_close("b", got.b, want.model.hidden_bias, kTolerance);
}

}  // namespace

TEST_CASE("steps of contrastive divergence, each by its own rule, are the double reference's") {
  // Seeds without a draw so close to its probability that rounding could decide it.
  const std::vector<CdScene> scenes = {CdScene({5, 4, 2, VisibleKind::gaussian}, 1),
                                       CdScene({4, 4, 2, VisibleKind::binary}, 1),
                                       CdScene({3, 4, 0, VisibleKind::gaussian}, 1)};
  for (const CdScene& scene : scenes) {
    INFO(scene.shape.visible, " visible units, order ", scene.shape.order);
    const CdWanted want = wanted(scene);
    REQUIRE(want.closest_draw > 5e-5);
    on_every_device([&](Device& device) {
      const auto tile = choose_chain_tile(device, scene.shape, kBatch);
      REQUIRE(tile);
      check_cd(device, scene, want, tile);
      check_cd(device, scene, want, std::nullopt);
    });
  }
}

TEST_CASE("steps of multi-prediction, each by its own rule, are the double reference's") {
  for (const MrbmScene& scene : {MrbmScene(3, 5, 6), MrbmScene(4, 4, 4)}) {
    const MrbmWanted want = wanted(scene);
    on_every_device([&](Device& device) {
      Mrbm fused(device, scene.start), composed(device, scene.start);
      const MrbmSettings settings{.mean_field_steps = kMeanFieldSteps};
      MultiPrediction fused_trainer(fused, kBatch, settings);
      MultiPrediction composed_trainer(composed, kBatch, settings, std::nullopt);
      check_multi_prediction(scene, want, fused, fused_trainer);
      check_multi_prediction(scene, want, composed, composed_trainer);
    });
  }
}

}  // namespace learning_steps_test
