#include "learning/contrastive_divergence.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace contrastive_divergence_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr RandomKey kKey{.seed = 11, .step = 3, .stream = 2};

struct CdCase {
  CrbmShape shape;
  std::size_t batch;
  std::size_t gibbs_steps;
};

const std::vector<CdCase> kSmallCases = {
    {{1, 1, 0, VisibleKind::gaussian}, 1, 1},       {{3, 5, 2, VisibleKind::binary}, 3, 2},
    {{31, 23, 5, VisibleKind::gaussian}, 7, 5},     {{17, 33, 1, VisibleKind::binary}, 21, 3},
    {{7, 9, 4, VisibleKind::gaussian, 1, 4}, 5, 2}, {{5, 6, 3, VisibleKind::binary, 3, 0}, 4, 1}};
const std::vector<CdCase> kModelCases = {{{96, 300, 5, VisibleKind::gaussian}, 2, 5},
                                         {{96, 300, 5, VisibleKind::gaussian}, 100, 1},
                                         {{300, 300, 5, VisibleKind::binary}, 100, 1}};

/// A CRBM in the middle of its training, with frames it could have seen.
class Scene {
 public:
  explicit Scene(const CdCase& cd) : cd_(cd) {
    const std::size_t visible = cd.shape.visible, hidden = cd.shape.hidden, order = cd.shape.order;
    parameters = CrbmParameters::zeros(cd.shape);
    const float scale = 1.0F / std::sqrt(static_cast<float>(visible));
    parameters.W = random_matrix(visible, hidden, 1, scale);
    parameters.A = random_matrix(cd.shape.order_A() * visible, visible, 2, 0.3F * scale);
    parameters.B = random_matrix(cd.shape.order_B() * visible, hidden, 3, 0.3F * scale);
    parameters.a = random_matrix(1, visible, 4, 0.2F);
    parameters.b = random_matrix(1, hidden, 5, 0.2F);
    frames = random_matrix(order + 2 * cd.batch + 3, visible, 6, 1.7F);
    if (cd.shape.kind == VisibleKind::binary)
      frames = ((frames.array() / 1.7F + 1.0F) / 2.0F).matrix();  // probabilities
    for (std::size_t r = 0; r < cd.batch; ++r)
      rows.push_back(static_cast<std::int32_t>(order + (2 * r + 1) % (2 * cd.batch + 3)));
  }

  reference::Crbm model() const { return in_double(parameters); }

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

/// As many equal mini-batches in a row, with the same random numbers each.
reference::BoundedCdStep bounded_steps(const Scene& scene, const CdRule& rule, std::size_t steps,
                                       const RandomKey& key) {
  const reference::Crbm start = scene.model();
  reference::BoundedCdStep result{
      reference::BoundedCrbm::exact(start), reference::BoundedCrbm::zeros_like(start), {}, 0};
  double uncertain_draws = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    result = reference::bounded_cd_step(result.parameters, result.velocities, scene.batch(),
                                        static_cast<int>(rule.gibbs_steps), scene.draws(key),
                                        rule.W, rule.A, rule.B);
    uncertain_draws = std::max(uncertain_draws, result.uncertain_draws);
  }
  result.uncertain_draws = uncertain_draws;
  return result;
}

/// A draw that rounding decides leaves the rest of its chain without a useful bound: the first
/// random numbers that leave next to none.
std::pair<RandomKey, reference::BoundedCdStep> clear_steps(const Scene& scene, const CdRule& rule,
                                                           std::size_t steps) {
  RandomKey key = kKey;
  reference::BoundedCdStep want;
  do {
    ++key.step;
    want = bounded_steps(scene, rule, steps, key);
  } while (want.uncertain_draws >= 1e-3 && key.step < kKey.step + 20);
  REQUIRE(want.uncertain_draws < 1e-3);
  return {key, want};
}

void check_one_step(const std::vector<CdCase>& cases) {
  for (const CdCase& cd : cases) {
    const Scene scene(cd);
    INFO("visible ", cd.shape.visible, ", hidden ", cd.shape.hidden, ", order ", cd.shape.order,
         ", batch ", cd.batch, ", k ", cd.gibbs_steps);
    const CdRule rule = rule_of(cd);
    const auto clear = clear_steps(scene, rule, 1);
    on_every_device([&](Device& device) {
      float loss = 0;
      check_within(scene.train(device, rule, 1, loss, clear.first), clear.second.parameters);
      check_within("loss", loss, clear.second.loss);
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

TEST_CASE("bounded CD steps compute what the plain reference computes") {
  for (const CdCase& cd : kSmallCases) {
    const Scene scene(cd);
    const CdRule rule = rule_of(cd);
    const auto bounded = bounded_steps(scene, rule, 2, kKey);
    reference::Crbm model = scene.model();
    reference::Crbm velocity =
        model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
    reference::CdResult last;
    for (int i = 0; i < 2; ++i) {
      last = reference::contrastive_divergence(model, scene.batch(),
                                               static_cast<int>(cd.gibbs_steps), scene.draws());
      reference::update(model, velocity, last.gradient, rule.W, rule.A, rule.B);
    }
    const auto same = [](const MatrixD& x, const MatrixD& y) {
      return x.size() == 0 || (x - y).cwiseAbs().maxCoeff() < 1e-12;
    };
    const auto all_same = [&](const reference::BoundedCrbm& x, const reference::Crbm& y) {
      CHECK(same(x.W.value, y.weights));
      CHECK(same(x.A.value, y.visible_history));
      CHECK(same(x.B.value, y.hidden_history));
      CHECK(same(x.a.value, y.visible_bias));
      CHECK(same(x.b.value, y.hidden_bias));
    };
    all_same(bounded.parameters, model);
    all_same(bounded.velocities, velocity);
    const MatrixD difference = scene.batch().visible - last.reconstruction;
    CHECK(same(bounded.loss.value, MatrixD::Constant(1, 1, difference.array().square().mean())));
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
  const Scene scene(kSmallCases[1]);
  CdRule rule = rule_of(kSmallCases[1]);
  const auto clear = clear_steps(scene, rule, 3);
  const reference::BoundedCrbm& want = clear.second.parameters;
  CHECK(want.W.bound.maxCoeff() < 1e-5);
  on_every_device([&](Device& device) {
    float loss = 0;
    check_within(scene.train(device, rule, 3, loss, clear.first), want);
    rule.W.momentum = 0;
    const CrbmParameters without = scene.train(device, rule, 3, loss, clear.first);
    CHECK((without.W.cast<double>() - want.W.value).cwiseAbs().maxCoeff() > 1e-3);
  });
}

}  // namespace contrastive_divergence_test
