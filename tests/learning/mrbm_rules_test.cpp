// Joint likelihood and CD-PercLoss, against double precision with their own draws and against
// enumeration.

#include <doctest/doctest.h>

#include <numeric>

#include "device/every_device.hpp"
#include "learning/joint_likelihood.hpp"
#include "learning/mrbm_rule.hpp"
#include "learning/multi_prediction.hpp"
#include "learning/perceptron_loss.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/crbm_enumeration.hpp"
#include "reference/units_reference.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kBinary = VisibleKind::binary, kGaussian = VisibleKind::gaussian;
constexpr RandomKey kKey{5, 9, 40, 0};

struct Scene {
  Scene(const std::vector<std::pair<std::size_t, VisibleKind>>& modalities, std::size_t hidden,
        std::size_t rows, float scale = 0.7F) {
    MrbmShape shape{{}, hidden};
    for (const auto& [visible, kind] : modalities)
      shape.modalities.push_back({std::to_string(shape.modalities.size()), visible, kind});
    start = MrbmParameters::zeros(shape);
    unsigned seed = 11;
    for (std::size_t m = 0; m < modalities.size(); ++m) {
      const auto& [visible, kind] = modalities[m];
      start.W[m] = random_matrix(visible, hidden, ++seed, scale);
      start.a[m] = random_matrix(1, visible, ++seed, 0.5F);
      const MatrixF drawn = random_matrix(rows, visible, ++seed);
      codes.push_back(kind == kGaussian ? drawn
                                        : MatrixF((0.5F * (drawn.array() + 1.0F)).matrix()));
    }
    start.b = random_matrix(1, hidden, ++seed, 0.5F);
    model = in_double(start);
  }
  std::size_t rows() const { return static_cast<std::size_t>(codes[0].rows()); }

  MrbmParameters start;
  std::vector<MatrixF> codes;
  reference::Mrbm model;
};

/// Chains in double precision. The smallest distance of a probability from its uniform number says
/// whether rounding could decide a draw.
struct ReferenceChain {
  const Scene& scene;
  const MrbmSettings& settings;
  double closest = 1.0;
  MatrixD hidden_data, hidden, sample;
  std::vector<MatrixD> data, end;

  ReferenceChain(const Scene& of, const MrbmSettings& with) : scene(of), settings(with) {
    for (const MatrixF& code : of.codes) data.push_back(code.cast<double>());
  }

  MatrixD drawn(const MatrixD& p, RandomKey key) {
    MatrixD result(p.rows(), p.cols());
    for (Eigen::Index r = 0; r < p.rows(); ++r)
      for (Eigen::Index c = 0; c < p.cols(); ++c) {
        const double u =
            random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
        closest = std::min(closest, std::abs(u - p(r, c)));
        result(r, c) = u < p(r, c) ? 1.0 : 0.0;
      }
    return result;
  }
  MatrixD hidden_of(const std::vector<MatrixD>& units) const {
    MatrixD input = scene.model.hidden_bias.replicate(units[0].rows(), 1);
    for (std::size_t m = 0; m < units.size(); ++m) input += units[m] * scene.model.weights[m];
    return reference::sigmoid(input);
  }
  MatrixD visible_of(std::size_t m, RandomKey key) {
    const MatrixD input = reference::plus_row(sample * scene.model.weights[m].transpose(),
                                              scene.model.visible_bias[m]);
    const MatrixD mean = scene.model.is_gaussian(m) ? input : reference::sigmoid(input);
    if (!settings.sample_visible) return mean;
    if (!scene.model.is_gaussian(m)) return drawn(mean, key);
    return mean + MatrixD::NullaryExpr(mean.rows(), mean.cols(), [&](auto r, auto c) {
             return random_normal(key, static_cast<std::uint32_t>(r),
                                  static_cast<std::uint32_t>(c));
           });
  }

  void start(const RandomKey& key) {
    hidden_data = hidden_of(data);
    sample = drawn(hidden_data, key);
  }
  void run(const std::vector<std::size_t>& free, const RandomKey& key, bool draw_last = false) {
    end = data;
    for (std::size_t k = 1; k <= settings.gibbs_steps; ++k) {
      for (const std::size_t m : free) {
        RandomKey own = key;
        own.phase = static_cast<std::uint16_t>(0x1000 + k * data.size() + m);
        end[m] = visible_of(m, own);
      }
      hidden = hidden_of(end);
      RandomKey own = key;
      own.phase = static_cast<std::uint16_t>(k);
      if (k < settings.gibbs_steps || draw_last) sample = drawn(hidden, own);
    }
  }
  /// Adds what rows of these weights give.
  void add(const Eigen::VectorXd& weights, reference::Mrbm& gradient) const {
    const MatrixD h_end = weights.asDiagonal() * hidden,
                  h_data = weights.asDiagonal() * hidden_data;
    for (std::size_t m = 0; m < data.size(); ++m) {
      gradient.weights[m] += end[m].transpose() * h_end - data[m].transpose() * h_data;
      gradient.visible_bias[m] += weights.transpose() * (end[m] - data[m]);
    }
    gradient.hidden_bias += (h_end - h_data).colwise().sum();
  }
  /// What of the free energy changes with modality m.
  Eigen::VectorXd energy(std::size_t m, const std::vector<MatrixD>& units) const {
    MatrixD input = scene.model.hidden_bias.replicate(units[0].rows(), 1);
    for (std::size_t i = 0; i < units.size(); ++i) input += units[i] * scene.model.weights[i];
    const Eigen::VectorXd hidden_part = -(1.0 + input.array().exp()).log().matrix().rowwise().sum();
    if (!scene.model.is_gaussian(m))
      return hidden_part - units[m] * scene.model.visible_bias[m].transpose();
    return hidden_part +
           0.5 * (units[m].rowwise() - scene.model.visible_bias[m]).rowwise().squaredNorm();
  }
};

reference::Mrbm zeros_like(const reference::Mrbm& model) {
  return model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
}

/// Runs `rule` on all rows, `steps` times, each with the next key. @return its last losses
std::vector<float> run(Device& device, const Scene& scene, LearningRule& rule, int steps = 1) {
  std::vector<Matrix> codes;
  for (const MatrixF& code : scene.codes) codes.push_back(Matrix::from_host(device, code));
  std::vector<std::int32_t> all(scene.rows());
  std::iota(all.begin(), all.end(), 0);
  const IndexBuffer index(device, all);
  std::vector<Rows> rows;
  for (const Matrix& code : codes) rows.push_back(Rows::indexed(code, index, 0, scene.rows()));
  LossAccumulator losses(device, rule.loss_count(), scene.rows());
  LearningStep step{1, 0.0, kKey};
  for (int i = 0; i < steps; ++i, ++step.random.step) {
    losses.read_and_reset();
    rule.learn(rows, step, losses);
  }
  return losses.read_and_reset();
}

void check_close(const MrbmParameters& got, const reference::Mrbm& want) {
  for (std::size_t m = 0; m < got.W.size(); ++m) {
    CAPTURE(m);
    CHECK((got.W[m].cast<double>() - want.weights[m]).cwiseAbs().maxCoeff() < 2e-6);
    CHECK((got.a[m].cast<double>() - want.visible_bias[m]).cwiseAbs().maxCoeff() < 2e-6);
  }
  CHECK((got.b.cast<double>() - want.hidden_bias).cwiseAbs().maxCoeff() < 2e-6);
}

const Scene& two() {
  static const Scene scene({{4, kBinary}, {3, kBinary}}, 5, 7);
  return scene;
}
const Scene& three() {
  static const Scene scene({{3, kBinary}, {4, kGaussian}, {2, kBinary}}, 4, 9);
  return scene;
}

}  // namespace

TEST_CASE("small: the joint likelihood's gradient is contrastive divergence over all modalities") {
  for (const Scene* scene : {&two(), &three()})
    for (const auto& [k, sampled] : {std::pair{1U, false}, {3U, false}, {2U, true}}) {
      CAPTURE(k);
      CAPTURE(sampled);
      const MrbmSettings settings{.gibbs_steps = k, .sample_visible = sampled};
      ReferenceChain chain(*scene, settings);
      std::vector<std::size_t> all(scene->codes.size());
      std::iota(all.begin(), all.end(), 0);
      chain.start(kKey);
      chain.run(all, kKey);
      REQUIRE(chain.closest > 1e-5);
      reference::Mrbm want = zeros_like(scene->model);
      const auto rows = static_cast<double>(scene->rows());
      chain.add(Eigen::VectorXd::Constant(chain.hidden.rows(), 1.0 / rows), want);
      on_every_device([&](Device& device) {
        Mrbm mrbm(device, scene->start);
        JointLikelihood rule(mrbm, scene->rows(), settings, OptimizerKind::none);
        const auto losses = run(device, *scene, rule, 1);
        check_close(rule.gradients(), want);
        for (std::size_t m = 0; m < losses.size(); ++m)
          CHECK(losses[m] == doctest::Approx((chain.end[m] - chain.data[m]).array().square().mean())
                                 .epsilon(1e-5));
      });
    }
}

TEST_CASE(
    "small: persistent chains of the joint likelihood go on where the last mini-batch ended") {
  const MrbmSettings settings{.gibbs_steps = 2, .persistent = true};
  ReferenceChain chain(two(), settings);
  const std::vector<std::size_t> all{0, 1};
  chain.start(kKey);
  chain.run(all, kKey, true);
  const MatrixD particles = chain.sample;
  RandomKey next = kKey;
  ++next.step;
  chain.start(next);
  chain.sample = particles;
  chain.run(all, next, true);
  REQUIRE(chain.closest > 1e-5);
  reference::Mrbm want = zeros_like(two().model);
  chain.add(Eigen::VectorXd::Constant(7, 1.0 / 7.0), want);
  on_every_device([&](Device& device) {
    Mrbm mrbm(device, two().start);
    JointLikelihood rule(mrbm, 7, settings, OptimizerKind::none);
    run(device, two(), rule, 2);
    check_close(rule.gradients(), want);
  });
}

TEST_CASE(
    "small: CD-PercLoss learns from rows whose chain ends lower than the data, and no others") {
  for (const Scene* scene : {&two(), &three()}) {
    const MrbmSettings settings{.gibbs_steps = 2};
    reference::Mrbm want = zeros_like(scene->model);
    int lower = 0, higher = 0;
    for (std::size_t m = 0; m < scene->codes.size(); ++m) {
      ReferenceChain chain(*scene, settings);
      RandomKey key = kKey;
      key.stream = static_cast<std::uint16_t>(kKey.stream + m);
      chain.start(key);
      chain.run({m}, key);
      REQUIRE(chain.closest > 1e-5);
      const Eigen::VectorXd gap = chain.energy(m, chain.end) - chain.energy(m, chain.data);
      REQUIRE(gap.cwiseAbs().minCoeff() > 1e-4);
      const auto is_lower = (gap.array() < 0.0).cast<double>();
      lower += static_cast<int>(is_lower.sum());
      higher += static_cast<int>(gap.size() - is_lower.sum());
      chain.add(is_lower.matrix() / static_cast<double>(scene->rows()), want);
    }
    REQUIRE(lower > 0);
    REQUIRE(higher > 0);
    on_every_device([&](Device& device) {
      Mrbm mrbm(device, scene->start);
      PerceptronLoss rule(mrbm, scene->rows(), settings, OptimizerKind::none);
      run(device, *scene, rule, 2);
      const MrbmParameters unlike = rule.gradients();  // the second step has other draws
      PerceptronLoss again(mrbm, scene->rows(), settings, OptimizerKind::none);
      run(device, *scene, again, 1);
      check_close(again.gradients(), want);
      CHECK(unlike.W[0] != again.gradients().W[0]);
    });
  }
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

TEST_CASE("the settings say which rule and which optimizer learn an MRBM") {
  on_every_device([](Device& device) {
    Mrbm mrbm(device, two().start);
    const auto rule = [&](const MrbmSettings& settings) {
      return make_mrbm_rule(mrbm, 7, settings);
    };
    CHECK(dynamic_cast<MultiPrediction*>(rule({}).get()));
    CHECK(dynamic_cast<JointLikelihood*>(rule({.joint_likelihood = true}).get()));
    CHECK(dynamic_cast<PerceptronLoss*>(rule({.perceptron_loss = true}).get()));
    CHECK_THROWS_AS(rule({.joint_likelihood = true, .perceptron_loss = true}), ConfigError);

    // One step of plain gradient descent: the gradient times the rate.
    for (const bool joint : {false, true}) {
      const MrbmSettings settings{.rate = 0.25,
                                  .joint_likelihood = joint,
                                  .perceptron_loss = !joint,
                                  .adam = false,
                                  .momentum = 0.5};
      Mrbm moved(device, two().start), still(device, two().start);
      run(device, two(), *make_mrbm_rule(moved, 7, settings));
      std::unique_ptr<MrbmChains> gradient;
      if (joint)
        gradient = std::make_unique<JointLikelihood>(still, 7, settings, OptimizerKind::none);
      else
        gradient = std::make_unique<PerceptronLoss>(still, 7, settings, OptimizerKind::none);
      run(device, two(), *gradient);
      const MatrixF step = moved.to_host().W[0] - two().start.W[0];
      CHECK((step + 0.25F * gradient->gradients().W[0]).cwiseAbs().maxCoeff() < 1e-6F);
      CHECK(moved.W_transposed[0].to_host() == moved.to_host().W[0].transpose());
    }
  });
}
