// An MRBM of more than two modalities, and of Gaussian ones.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/mrbm_chain.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "reference/error_bounds.hpp"
#include "reference/mrbm_chain_reference.hpp"
#include "reference/units_reference.hpp"

namespace mrbm_modalities_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::misfit;

namespace {

constexpr VisibleKind kBinary = VisibleKind::binary, kGaussian = VisibleKind::gaussian;
constexpr std::size_t kRows = 5;

/// An MRBM and values of every modality.
struct Problem {
  Problem(const std::vector<std::pair<std::size_t, VisibleKind>>& modalities, std::size_t hidden) {
    MrbmShape shape{{}, hidden};
    for (const auto& [visible, kind] : modalities)
      shape.modalities.push_back({std::to_string(shape.modalities.size()), visible, kind});
    start = MrbmParameters::zeros(shape);
    unsigned seed = 0;
    const auto fill = [&](MatrixF& x, float scale) {
      x = random_matrix(static_cast<std::size_t>(x.rows()), static_cast<std::size_t>(x.cols()),
                        ++seed, scale);
    };
    for (MatrixF& W : start.W) fill(W, 0.6F);
    for (MatrixF& a : start.a) fill(a, 0.5F);
    fill(start.b, 0.5F);
    for (std::size_t m = 0; m < modalities.size(); ++m) {
      const MatrixF drawn = random_matrix(kRows, modalities[m].first, ++seed);
      values.push_back(modalities[m].second == kGaussian
                           ? drawn
                           : MatrixF((0.5F * (drawn.array() + 1.0F)).matrix()));
      model.weights.push_back(start.W[m].cast<double>());
      model.visible_bias.push_back(start.a[m].cast<double>());
      model.gaussian.push_back(modalities[m].second == kGaussian);
    }
    model.hidden_bias = start.b.cast<double>();
  }

  std::vector<Bounded> want(const std::vector<bool>& present, const MrbmChainOptions& o) const {
    std::vector<MatrixD> in_double;
    for (const MatrixF& value : values) in_double.push_back(value.cast<double>());
    const auto numbers = [&](const auto& number) {
      return [&number, key = o.random](int pass, Eigen::Index units) {
        RandomKey own = key;
        const int phase = key.phase + pass;  // 0x4000 of them, then the next step
        own.phase = static_cast<std::uint16_t>(phase & 0x3fff);
        own.step += static_cast<std::uint32_t>(phase >> 14);
        return MatrixD(
            MatrixD::NullaryExpr(Eigen::Index{kRows}, units, [&](Eigen::Index r, Eigen::Index c) {
              return number(own, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
            }));
      };
    };
    return reference::bounded_chain(model, present, in_double,
                                    {static_cast<int>(o.steps), static_cast<double>(o.temperature)},
                                    numbers(random_uniform), numbers(random_normal));
  }

  std::vector<MatrixF> got(Device& device, const std::vector<bool>& present,
                           const MrbmChainOptions& options) const {
    const Mrbm mrbm(device, start);
    std::vector<Matrix> on_device;
    std::vector<Rows> rows;
    for (std::size_t m = 0; m < values.size(); ++m)
      // What stands where the answer goes must not count.
      on_device.push_back(
          Matrix::from_host(device, present[m] ? values[m] : MatrixF(values[m] * 9)));
    for (const Matrix& matrix : on_device) rows.emplace_back(matrix);
    MrbmChain(mrbm, present, kRows).run(rows, options);
    std::vector<MatrixF> result;
    for (const Matrix& matrix : on_device) result.push_back(matrix.to_host());
    return result;
  }

  void check(const std::vector<bool>& present, const MrbmChainOptions& options) const {
    const std::vector<Bounded> wanted = want(present, options);
    on_every_device([&](Device& device) {
      const std::vector<MatrixF> found = got(device, present, options);
      for (std::size_t m = 0; m < present.size(); ++m) {
        CAPTURE(m);
        if (present[m]) {
          CHECK(found[m] == values[m]);
          continue;
        }
        int compared = 0;
        for (Eigen::Index r = 0; r < found[m].rows(); ++r) {
          if (!(wanted[m].bound.row(r).maxCoeff() < 1e-2)) continue;  // rounding decides a draw
          ++compared;
          CHECK(misfit(found[m].row(r), wanted[m].value.row(r), wanted[m].bound.row(r)) == "");
        }
        CHECK(compared >= 3);
      }
    });
  }

  MrbmParameters start;
  reference::Mrbm model;
  std::vector<MatrixF> values;
};

MrbmChainOptions options_with(std::size_t steps, float temperature) {
  return {steps, temperature, Sampling::bernoulli, {77, 3, 2, 0}};
}

}  // namespace

TEST_CASE("small: the mean field of three modalities, one or two of them absent, is eq 32 and 33") {
  const Problem problem({{4, kBinary}, {7, kBinary}, {3, kBinary}}, 5);
  for (const std::vector<bool>& present :
       {std::vector<bool>{true, true, false}, {false, true, true}, {true, false, false}})
    problem.check(present, options_with(3, 0.0F));
  problem.check({false, false, false}, options_with(2, 0.0F));  // from b alone
}

TEST_CASE("small: a Gaussian modality is inferred, and others from it, by its own units") {
  const Problem two({{6, kGaussian}, {5, kBinary}}, 7);
  const Problem three({{4, kGaussian}, {17, kBinary}, {3, kGaussian}}, 6);
  for (const float temperature : {0.0F, 1.0F, 0.4F}) {
    CAPTURE(temperature);
    two.check({true, false}, options_with(2, temperature));
    two.check({false, true}, options_with(2, temperature));
    three.check({true, false, false}, options_with(2, temperature));
    three.check({false, true, false}, options_with(1, temperature));
  }
}

TEST_CASE("small: a chain of three modalities draws hidden units, then each absent one") {
  const Problem problem({{4, kBinary}, {7, kBinary}, {3, kBinary}}, 5);
  problem.check({true, false, false}, options_with(2, 1.0F));
  problem.check({false, true, true}, options_with(3, 1.0F));
}

TEST_CASE("small: a long chain draws Gaussian units, too, from further steps") {
  const Problem problem({{4, kGaussian}, {7, kBinary}, {3, kGaussian}}, 5);
  for (const unsigned phase : {0x3fffU, 0x7ffeU, 0xfffbU}) {
    MrbmChainOptions options = options_with(2, 1.0F);
    options.random.phase = static_cast<std::uint16_t>(phase);
    problem.check({true, false, false}, options);
  }
}

TEST_CASE("small: an MRBM wants two modalities or more, each with a name of its own") {
  on_every_device([](Device& device) {
    CHECK_THROWS_AS(Mrbm(device, MrbmParameters::zeros({{{"only", 3}}, 2})), ShapeError);
    CHECK_THROWS_AS(Mrbm(device, MrbmParameters::zeros({{{"x", 3}, {"x", 4}}, 2})), ShapeError);
    const Problem problem({{4, kBinary}, {7, kBinary}, {3, kBinary}}, 5);
    const Mrbm mrbm(device, problem.start);
    CHECK(mrbm.modality_count() == 3);
    CHECK(mrbm.visible(2) == 3);
    CHECK(mrbm.parameters().entry("W_1").rows == 7);
    CHECK_THROWS_AS(MrbmChain(mrbm, {true, true, true}, 2), ShapeError);
    CHECK_THROWS_AS(MrbmChain(mrbm, {true, false}, 2), ShapeError);
  });
}

TEST_CASE("small: the free energy of an MRBM sums its hidden units out of eq 19") {
  const Problem problem({{4, kBinary}, {3, kGaussian}, {2, kBinary}}, 5);
  on_every_device([&](Device& device) {
    const Mrbm mrbm(device, problem.start);
    std::vector<Matrix> values;
    for (const MatrixF& value : problem.values) values.push_back(Matrix::from_host(device, value));
    const MatrixF got = free_energy(mrbm, {values.begin(), values.end()}).to_host();
    for (Eigen::Index r = 0; r < got.rows(); ++r) {
      // Σ over all 2^5 states of the hidden units of exp(−E).
      double sum = 0;
      for (int state = 0; state < 32; ++state) {
        double energy = 0;
        for (std::size_t m = 0; m < 3; ++m) {
          const RowVectorD v = problem.values[m].row(r).cast<double>();
          const RowVectorD& a = problem.model.visible_bias[m];
          energy += m == 1 ? 0.5 * (v - a).squaredNorm() : -v.dot(a);
          for (int k = 0; k < 5; ++k)
            if (state >> k & 1) energy -= v.dot(problem.model.weights[m].col(k));
        }
        for (int k = 0; k < 5; ++k)
          if (state >> k & 1) energy -= problem.model.hidden_bias(k);
        sum += std::exp(-energy);
      }
      CHECK(std::abs(got(r, 0) + std::log(sum)) < 1e-4);
    }
    CHECK_THROWS_AS(free_energy(mrbm, {values[0], values[1]}), ShapeError);
  });
}

TEST_CASE("an MRBM reconstructs by its means and draws what is not given as enumeration gives") {
  constexpr std::size_t kChains = 8000;
  const Problem problem({{3, kBinary}, {2, kBinary}}, 3);
  const reference::HiddenStates states =
      reference::enumerate_hidden(problem.model, 0, problem.values[0].row(0).cast<double>());
  on_every_device([&](Device& device) {
    const Mrbm mrbm(device, problem.start);
    const Matrix given =
        Matrix::filled_with_row(Matrix::from_host(device, problem.values[0].topRows(1)), kChains);
    const auto drawn = sample(mrbm, {given, Matrix()}, {true, false}, kChains, {.steps = 60});
    CHECK(drawn[0].to_host() == given.to_host());
    const MatrixF values = drawn[1].to_host();
    CHECK(((values.array() == 0.0F) || (values.array() == 1.0F)).all());
    const RowVectorD want = states.stationary * states.absent;
    // Five standard deviations of a mean of so many draws.
    CHECK((values.cast<double>().colwise().mean() - want).cwiseAbs().maxCoeff() <
          2.5 / std::sqrt(static_cast<double>(kChains)));
    const auto free = sample(mrbm, {Matrix(), Matrix()}, {false, false}, 7, {.seed = 3});
    const auto again = sample(mrbm, {Matrix(), Matrix()}, {false, false}, 7, {.seed = 3});
    CHECK(free[0].to_host() == again[0].to_host());
    CHECK(free[0].rows() == 7);

    const Matrix first = Matrix::from_host(device, problem.values[0]),
                 second = Matrix::from_host(device, problem.values[1]);
    const auto back = reconstruct(mrbm, {first, second});
    const MatrixD hidden =
        reference::sigmoid(problem.values[0].cast<double>() * problem.model.weights[0] +
                           problem.values[1].cast<double>() * problem.model.weights[1] +
                           problem.model.hidden_bias.replicate(kRows, 1));
    const MatrixD means = reference::sigmoid(reference::plus_row(
        hidden * problem.model.weights[1].transpose(), problem.model.visible_bias[1]));
    CHECK((back[1].to_host().cast<double>() - means).cwiseAbs().maxCoeff() < 1e-5);
  });
}

}  // namespace mrbm_modalities_test
