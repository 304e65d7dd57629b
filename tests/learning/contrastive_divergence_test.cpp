#include "learning/contrastive_divergence.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/machines/sequences.hpp"
#include "reference/crbm_error_bound.hpp"
#include "reference/error_bounds.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using reference::misfit;

namespace {

constexpr RandomKey kKey{.seed = 11, .step = 3, .stream = 2};

struct CdCase {
  CrbmShape shape;
  std::size_t batch;
  std::size_t gibbs_steps;
};

const std::vector<CdCase> kSmallCases = {{{1, 1, 0, VisibleKind::gaussian}, 1, 1},
                                         {{3, 5, 2, VisibleKind::binary}, 3, 2},
                                         {{31, 23, 5, VisibleKind::gaussian}, 7, 5},
                                         {{17, 33, 1, VisibleKind::binary}, 21, 3}};
const std::vector<CdCase> kModelCases = {{{96, 300, 5, VisibleKind::gaussian}, 2, 5},
                                         {{96, 300, 5, VisibleKind::gaussian}, 100, 1},
                                         {{300, 300, 5, VisibleKind::binary}, 100, 1}};

/// A CRBM in the middle of its training, with frames it could have seen.
class Scene {
 public:
  explicit Scene(const CdCase& cd) : cd_(cd) {
    const auto [visible, hidden, order, kind] = cd.shape;
    parameters = CrbmParameters::zeros(cd.shape);
    const float scale = 1.0F / std::sqrt(static_cast<float>(visible));
    parameters.W = random_matrix(visible, hidden, 1, scale);
    parameters.A = random_matrix(order * visible, visible, 2, 0.3F * scale);
    parameters.B = random_matrix(order * visible, hidden, 3, 0.3F * scale);
    parameters.a = random_matrix(1, visible, 4, 0.2F);
    parameters.b = random_matrix(1, hidden, 5, 0.2F);
    frames = random_matrix(order + 2 * cd.batch + 3, visible, 6, 1.7F);
    if (kind == VisibleKind::binary)
      frames = ((frames.array() / 1.7F + 1.0F) / 2.0F).matrix();  // probabilities
    for (std::size_t r = 0; r < cd.batch; ++r)
      rows.push_back(static_cast<std::int32_t>(order + (2 * r + 1) % (2 * cd.batch + 3)));
  }

  reference::Crbm model() const {
    return {cd_.shape.kind == VisibleKind::gaussian ? reference::VisibleUnits::gaussian
                                                    : reference::VisibleUnits::binary,
            parameters.W.cast<double>(),
            parameters.A.cast<double>(),
            parameters.B.cast<double>(),
            parameters.a.cast<double>(),
            parameters.b.cast<double>()};
  }

  reference::CrbmBatch batch() const {
    const auto visible = frames.cols();
    const auto order = static_cast<Eigen::Index>(cd_.shape.order);
    const auto count = static_cast<Eigen::Index>(rows.size());
    reference::CrbmBatch result{MatrixD(count, visible), MatrixD(count, order * visible)};
    for (Eigen::Index r = 0; r < count; ++r) {
      const Eigen::Index t = rows[static_cast<std::size_t>(r)];
      result.visible.row(r) = frames.row(t).cast<double>();
      for (Eigen::Index q = 0; q < order; ++q)
        result.history.block(r, q * visible, 1, visible) = frames.row(t - order + q).cast<double>();
    }
    return result;
  }

  reference::HiddenDraws draws(const RandomKey& first = kKey) const {
    return [this, first](int gibbs_step) {
      RandomKey key = first;
      key.phase = static_cast<std::uint16_t>(gibbs_step);
      MatrixD uniform(rows.size(), parameters.b.cols());
      for (Eigen::Index r = 0; r < uniform.rows(); ++r)
        for (Eigen::Index j = 0; j < uniform.cols(); ++j)
          uniform(r, j) =
              random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(j));
      return uniform;
    };
  }

  /// The parameters after `steps` equal mini-batches on the device, and the last one's loss.
  CrbmParameters train(Device& device, const CdRule& rule, std::size_t steps, float& loss,
                       const RandomKey& key = kKey) const {
    const Sequences sequences = Sequences::from_host(device, {frames});
    const IndexBuffer index(device, rows);
    Crbm crbm(device, parameters);
    ContrastiveDivergence cd(crbm, rows.size());
    LossAccumulator losses(device, 1, rows.size());
    for (std::size_t i = 0; i < steps; ++i)
      cd.step(Rows::indexed(sequences.values, index, 0, rows.size()), rule, key, losses);
    loss = losses.read_and_reset().front() / static_cast<float>(steps);
    return crbm.to_host();
  }

  CrbmParameters parameters;
  MatrixF frames;
  std::vector<std::int32_t> rows;

 private:
  CdCase cd_;
};

CdRule rule_of(const CdCase& cd) {
  CdRule rule;
  rule.gibbs_steps = cd.gibbs_steps;
  rule.W = {0.5F, 0.9F, 0.01F};
  rule.A = {0.25F, 0.9F, 0.02F};
  rule.B = {0.125F, 0.9F, 0.03F};
  return rule;
}

void check_parameter(const char* name, const MatrixF& got, const reference::Bounded& want) {
  INFO("parameter ", name);
  CHECK(misfit(got, want.value, want.bound) == "");
}

void check_one_step(const std::vector<CdCase>& cases) {
  for (const CdCase& cd : cases) {
    const Scene scene(cd);
    INFO("visible ", cd.shape.visible, ", hidden ", cd.shape.hidden, ", order ", cd.shape.order,
         ", batch ", cd.batch, ", k ", cd.gibbs_steps);
    const CdRule rule = rule_of(cd);
    // A draw that rounding decides leaves the rest of its chain without a useful bound: take the
    // first random numbers that leave next to none.
    RandomKey key = kKey;
    reference::BoundedCdStep want;
    do {
      ++key.step;
      want =
          reference::bounded_cd_step(scene.model(), scene.batch(), static_cast<int>(cd.gibbs_steps),
                                     scene.draws(key), rule.W, rule.A, rule.B);
    } while (want.uncertain_draws >= 1e-3 && key.step < kKey.step + 20);
    REQUIRE(want.uncertain_draws < 1e-3);
    on_every_device([&](Device& device) {
      float loss = 0;
      const CrbmParameters got = scene.train(device, rule, 1, loss, key);
      check_parameter("W", got.W, want.parameters.W);
      check_parameter("A", got.A, want.parameters.A);
      check_parameter("B", got.B, want.parameters.B);
      check_parameter("a", got.a, want.parameters.a);
      check_parameter("b", got.b, want.parameters.b);
    });
  }
}

}  // namespace

TEST_CASE("small: one CD step gives the double reference's parameters within rounding") {
  check_one_step(kSmallCases);
}

TEST_CASE("one CD step at the model's sizes, within rounding") {
  check_one_step(kModelCases);
}

TEST_CASE("the bounded CD step computes what the plain reference computes") {
  for (const CdCase& cd : kSmallCases) {
    const Scene scene(cd);
    const CdRule rule = rule_of(cd);
    const int k = static_cast<int>(cd.gibbs_steps);
    reference::Crbm model = scene.model();
    const auto bounded =
        reference::bounded_cd_step(model, scene.batch(), k, scene.draws(), rule.W, rule.A, rule.B);
    const auto gradient =
        reference::contrastive_divergence(model, scene.batch(), k, scene.draws()).gradient;
    reference::Crbm velocity =
        model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
    reference::update(model, velocity, gradient, rule.W, rule.A, rule.B);
    const auto same = [](const MatrixD& x, const MatrixD& y) {
      return x.size() == 0 || (x - y).cwiseAbs().maxCoeff() < 1e-12;
    };
    CHECK(same(bounded.parameters.W.value, model.weights));
    CHECK(same(bounded.parameters.A.value, model.visible_history));
    CHECK(same(bounded.parameters.B.value, model.hidden_history));
    CHECK(same(bounded.parameters.a.value, model.visible_bias));
    CHECK(same(bounded.parameters.b.value, model.hidden_bias));
  }
}

TEST_CASE("small: the loss of a CD step is the mean squared reconstruction error of a unit") {
  for (const CdCase& cd : kSmallCases) {
    const Scene scene(cd);
    const auto want = reference::contrastive_divergence(
        scene.model(), scene.batch(), static_cast<int>(cd.gibbs_steps), scene.draws());
    const double loss = (scene.batch().visible - want.reconstruction).squaredNorm() /
                        static_cast<double>(want.reconstruction.size());
    on_every_device([&](Device& device) {
      float got = 0;
      scene.train(device, rule_of(cd), 1, got);
      CHECK(got == doctest::Approx(loss).epsilon(1e-4));
    });
  }
}

TEST_CASE("small: CD steps with one seed give the same bits, with another seed others") {
  const Scene scene(kSmallCases[2]);
  on_every_device([&](Device& device) {
    float loss = 0;
    const CrbmParameters once = scene.train(device, rule_of(kSmallCases[2]), 7, loss);
    const CrbmParameters again = scene.train(device, rule_of(kSmallCases[2]), 7, loss);
    CHECK((once.W.array() == again.W.array()).all());
    CHECK((once.A.array() == again.A.array()).all());
    CHECK((once.B.array() == again.B.array()).all());
    CHECK((once.W.array() != scene.parameters.W.array()).any());
  });
}

TEST_CASE("small: momentum carries a CD step into the next one") {
  const CdCase& cd = kSmallCases[1];
  const Scene scene(cd);
  CdRule rule = rule_of(cd);
  const int k = static_cast<int>(cd.gibbs_steps);
  reference::Crbm model = scene.model();
  reference::Crbm velocity = model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
  for (int i = 0; i < 3; ++i)
    reference::update(
        model, velocity,
        reference::contrastive_divergence(model, scene.batch(), k, scene.draws()).gradient, rule.W,
        rule.A, rule.B);
  on_every_device([&](Device& device) {
    float loss = 0;
    const CrbmParameters got = scene.train(device, rule, 3, loss);
    CHECK((got.W.cast<double>() - model.weights).cwiseAbs().maxCoeff() < 1e-5);
    rule.W.momentum = 0;
    const CrbmParameters without = scene.train(device, rule, 3, loss);
    CHECK((without.W.cast<double>() - model.weights).cwiseAbs().maxCoeff() > 1e-3);
  });
}
