// log Z by annealed importance sampling against log Z by enumeration.

#include "mcdbn/machines/partition.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/kernel_arguments.hpp"
#include "machines/in_double.hpp"
#include "machines/tiny_crbm.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/energy.hpp"
#include "reference/crbm_enumeration.hpp"
#include "reference/error_bounds.hpp"
#include "reference/finite_difference.hpp"
#include "reference/running_error.hpp"

namespace partition_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

const std::vector<CrbmShape> kShapes = {
    {11, 9, 0, kBinary}, {5, 14, 0, kGaussian}, {4, 6, 2, kBinary}, {3, 7, 3, kGaussian}};

RowVectorF history_of(const CrbmShape& shape) {
  const RowVectorF values = random_matrix(1, shape.order * shape.visible, 77);
  return shape.kind == kGaussian ? values : RowVectorF((values.array() > 0.0F).cast<float>());
}

double exact_log_partition(const CrbmParameters& p) {
  return reference::log_partition(in_double(p), history_of(p.shape).cast<double>())(0);
}

/// One temperature for some chains, as the kernel alone makes it.
struct Annealed {
  Matrix input, visible, difference, log_weight, lost, sample;

  Annealed(Device& device, std::size_t chains, std::size_t visible_units, std::size_t hidden_units)
      : input(Matrix::from_host(device, random_matrix(chains, hidden_units, 1, 3.0F))),
        visible(Matrix::from_host(device, random_matrix(chains, visible_units, 2))),
        difference(Matrix::from_host(device, random_matrix(1, visible_units, 3))),
        log_weight(device, chains, 1),
        lost(device, chains, 1),
        sample(device, chains, hidden_units) {}

  void run(float before, float after, const RandomKey& key) {
    Device& device = input.device();
    cl::Kernel& kernel = device.programs().kernel("energy.cl", "anneal",
                                                  {{"VEC", vector_width(device)}, {"SAMPLE", 1}});
    launch(device, kernel, {{input.rows(), 1}}, input.buffer(), to_int(input.stride()),
           to_int(input.columns()), visible.buffer(), to_int(visible.stride()), difference.buffer(),
           to_int(visible.columns()), before, after, log_weight.buffer(), lost.buffer(),
           to_int(log_weight.stride()), sample.buffer(), to_int(sample.stride()),
           random_argument(key));
  }
};

}  // namespace

TEST_CASE("small: one temperature weighs each chain and draws its hidden units") {
  using reference::Bounded;
  constexpr float kBefore = 0.25F, kAfter = 0.375F;
  on_every_device([](Device& device) {
    for (const auto& [chains, visible, hidden] :
         {std::tuple<std::size_t, std::size_t, std::size_t>{11, 3, 17}, {1, 1, 1}, {6, 16, 5}}) {
      Annealed one(device, chains, visible, hidden);
      const RandomKey key{5, 7, 212, 0};
      one.run(kBefore, kAfter, key);
      const auto exact = [](const Matrix& m) { return Bounded::exact(m.to_host().cast<double>()); };
      const Bounded x = exact(one.input);
      const auto row_sums = [](const Bounded& m) {
        return column_sum(m.transposed()).transposed();
      };
      const Bounded seen =
          (kAfter - kBefore) * product(exact(one.visible), exact(one.difference).transposed());
      const Bounded want = seen + row_sums(softplus(kAfter * x) - softplus(kBefore * x));
      CHECK(reference::misfit(one.log_weight.to_host(), want.value, want.bound) == "");
      MatrixD uniform(x.value.rows(), x.value.cols());
      for (Eigen::Index r = 0; r < uniform.rows(); ++r)
        for (Eigen::Index j = 0; j < uniform.cols(); ++j)
          uniform(r, j) =
              random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(j));
      const Bounded bits = bernoulli(sigmoid(kAfter * x), uniform);
      CHECK(bits.bound.sum() == 0.0);
      CHECK(one.sample.to_host().cast<double>() == bits.value);
      for (const Matrix* matrix : {&one.log_weight, &one.lost, &one.sample})
        CHECK(padding_is_zero(*matrix));
    }
  });
}

TEST_CASE("thousands of temperatures round a chain's weight no more than two do") {
  on_every_device([](Device& device) {
    Annealed chains(device, 5, 3, 7);
    chains.run(0.25F, 0.2501F, {});
    const Eigen::ArrayXd once = chains.log_weight.to_host().col(0).cast<double>();
    constexpr int kTimes = 3000;
    for (int i = 1; i < kTimes; ++i) chains.run(0.25F, 0.2501F, {});
    const Eigen::ArrayXd got = chains.log_weight.to_host().col(0).cast<double>();
    CHECK(
        ((got - kTimes * once).abs() <= 2.0 * reference::kRoundoff * (kTimes * once).abs()).all());
  });
}

TEST_CASE("reference: log Z's derivatives are the expected statistics") {
  for (const CrbmShape& shape : {CrbmShape{3, 4, 0, kBinary}, CrbmShape{3, 4, 2, kGaussian}}) {
    const reference::Crbm model = in_double(tiny_crbm(shape, 5));
    const MatrixD history = history_of(shape).cast<double>();
    const Eigen::VectorXd numeric = reference::finite_difference(
        [&](const Eigen::VectorXd& x) {
          const reference::Crbm moved = model.with_parameters(x);
          // Of Gaussian units exp(−½ |v − â|²) holds exp(−½ |â|²), which p(v) does not see.
          const MatrixD bias = reference::dynamic_visible_bias(moved, history);
          return reference::log_partition(moved, history)(0) +
                 (shape.kind == kGaussian ? 0.5 * bias.squaredNorm() : 0.0);
        },
        model.flattened());
    const Eigen::VectorXd analytic = reference::expected_statistics(model, history).flattened();
    CHECK((numeric - analytic).cwiseAbs().maxCoeff() < 1e-7);
  }
}

TEST_CASE("annealed importance sampling finds log Z within its own error") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : kShapes) {
      INFO(shape.visible, " visible, ", shape.hidden, " hidden, order ", shape.order);
      const CrbmParameters p = tiny_crbm(shape, 101);
      const double want = exact_log_partition(p);
      // Few temperatures make the weights uneven, but their mean is right with any number.
      for (const AisSettings& settings :
           {AisSettings{300, 400, 1}, AisSettings{300, 400, 2}, AisSettings{10, 20'000, 3}}) {
        CAPTURE(settings.temperatures);
        const LogPartition got = log_partition(Crbm(device, p), settings, history_of(shape));
        CAPTURE(got.value);
        CAPTURE(want);
        CAPTURE(got.standard_error);
        CHECK(std::abs(got.value - want) < 4.0 * got.standard_error);
        CHECK(got.standard_error < 0.05);
        CHECK(got.standard_error > 1e-5);
      }
    }
  });
}

TEST_CASE("annealed importance sampling of a large machine whose log Z is a sum of small ones") {
  // Blocks that do not see each other: log Z is the sum of theirs.
  constexpr std::size_t kBlocks = 24;
  const CrbmShape block{10, 6, 0, kBinary};
  CrbmParameters p = CrbmParameters::zeros({kBlocks * 10, kBlocks * 6, 0, kBinary});
  double want = 0;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    const CrbmParameters one = tiny_crbm(block, static_cast<unsigned>(200 + 10 * i));
    const auto v = static_cast<Eigen::Index>(10 * i), h = static_cast<Eigen::Index>(6 * i);
    p.W.block(v, h, 10, 6) = one.W;
    p.a.middleCols(v, 10) = one.a;
    p.b.middleCols(h, 6) = one.b;
    p.visible_mean.middleCols(v, 10) = one.visible_mean;
    want += exact_log_partition(one);
  }
  on_every_device([&](Device& device) {
    const LogPartition got =
        log_partition(Crbm(device, p), {.temperatures = 500, .chains = 200, .seed = 4});
    CAPTURE(got.value);
    CAPTURE(want);
    CAPTURE(got.standard_error);
    CHECK(std::abs(got.value - want) < 4.0 * got.standard_error);
    CHECK(got.standard_error < 0.1);
  });
}

TEST_CASE("the standard error is how far estimates of log Z lie from each other") {
  const CrbmParameters p = tiny_crbm({6, 8, 0, kBinary}, 111, 2.0F);
  const double want = exact_log_partition(p);
  on_every_device([&](Device& device) {
    const Crbm rbm(device, p);
    constexpr int kRuns = 40;
    double squares = 0, errors = 0;
    for (int run = 0; run < kRuns; ++run) {
      const LogPartition got = log_partition(
          rbm, {.temperatures = 30, .chains = 200, .seed = static_cast<std::uint64_t>(run + 1)});
      squares += (got.value - want) * (got.value - want) / kRuns;
      errors += got.standard_error * got.standard_error / kRuns;
    }
    // The ratio of a chi-square of 40 degrees of freedom to its mean: 0.5 … 1.75 but for 1 in 500.
    CHECK(squares / errors > 0.45);
    CHECK(squares / errors < 1.9);
  });
}

TEST_CASE("without weights one temperature is exact") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : kShapes) {
      CrbmParameters p = tiny_crbm(shape, 121);
      p.W.setZero();
      p.b.setZero();
      p.B.setZero();
      // Then the base is the machine but for its visible biases.
      if (shape.kind == kBinary) {
        p.A.setZero();
        p.a = (p.visible_mean.array() / (1.0F - p.visible_mean.array())).log().matrix();
      }
      const LogPartition got =
          log_partition(Crbm(device, p), {.temperatures = 1, .chains = 5}, history_of(shape));
      CHECK(std::abs(got.value - exact_log_partition(p)) < 1e-5);
      CHECK(got.standard_error < 1e-6);
    }
  });
}

TEST_CASE("log p(v) by free energy and log Z sums to one over all states") {
  on_every_device([](Device& device) {
    const CrbmParameters p = tiny_crbm({6, 9, 0, kBinary}, 131);
    const Crbm rbm(device, p);
    const MatrixF states = reference::all_states(6).cast<float>();
    const Eigen::ArrayXd energy = free_energy(rbm, Sequences::from_host(device, {states}))
                                      .values.to_host()
                                      .col(0)
                                      .cast<double>();
    const LogPartition z = log_partition(rbm, {.temperatures = 300, .chains = 400});
    CHECK(std::abs((-energy - z.value).exp().sum() - 1.0) < 5.0 * z.standard_error);
  });
}

TEST_CASE("log Z: settings and histories that do not fit are refused") {
  on_every_device([](Device& device) {
    const Crbm crbm(device, tiny_crbm({3, 2, 1, kBinary}, 1));
    CHECK_THROWS_AS(log_partition(crbm), ShapeError);
    CHECK_THROWS_AS(log_partition(crbm, {}, RowVectorF::Zero(4)), ShapeError);
    CHECK_THROWS_AS(log_partition(crbm, {.chains = 1}, RowVectorF::Zero(3)), ConfigError);
    CHECK_THROWS_AS(log_partition(crbm, {.temperatures = 0}, RowVectorF::Zero(3)), ConfigError);
  });
}

}  // namespace partition_test
