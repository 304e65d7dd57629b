#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "device/shapes.hpp"
#include "reference/error_bounds.hpp"
#include "reference/product_reference.hpp"
#include "reference/units_reference.hpp"

namespace gemm_epilogue_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::misfit;

namespace {

enum class BiasKind { none, row, matrix };

struct Epilogue {
  BiasKind bias = BiasKind::none;
  Activation activation = Activation::none;
  Sampling sampling = Sampling::none;
  float temperature = 1.0F;
  float kept_share = 1.0F;
};

/// Those of the model's stochastic units, all combined, those of the perceptron and of the joint
/// stage.
std::vector<Epilogue> all_epilogues() {
  std::vector<Epilogue> all{{BiasKind::row, Activation::relu},
                            {BiasKind::none, Activation::relu_gradient},
                            {BiasKind::row, Activation::centered_sigmoid},
                            {BiasKind::none, Activation::centered_sigmoid_gradient}};
  Epilogue dropped{BiasKind::none, Activation::centered_sigmoid_gradient};
  dropped.kept_share = 0.75F;
  all.push_back(dropped);
  for (const auto bias : {BiasKind::none, BiasKind::row, BiasKind::matrix})
    for (const auto activation :
         {Activation::none, Activation::sigmoid, Activation::sigmoid_gradient})
      for (const auto sampling : {Sampling::none, Sampling::bernoulli, Sampling::gaussian})
        all.push_back({bias, activation, sampling});
  return all;
}

/// A third of those combined, in which each two values of a pair still meet, and the others.
std::vector<Epilogue> every_pair() {
  std::vector<Epilogue> all = all_epilogues();
  std::erase_if(all, [](const Epilogue& epilogue) {
    const int sum = static_cast<int>(epilogue.bias) + static_cast<int>(epilogue.activation) +
                    static_cast<int>(epilogue.sampling);
    return epilogue.activation <= Activation::sigmoid_gradient && sum % 3 != 0;
  });
  return all;
}

/// Those of the model: units of eq 6 to 11 with dynamic biases, mean field, back-propagation.
const std::vector<Epilogue> kModelEpilogues = {
    {BiasKind::matrix, Activation::sigmoid, Sampling::bernoulli},
    {BiasKind::matrix, Activation::none, Sampling::gaussian},
    {BiasKind::row, Activation::sigmoid, Sampling::none},
    {BiasKind::none, Activation::sigmoid_gradient, Sampling::none},
};

const RandomKey kKey{.seed = 0xfeedface12345678, .step = 41, .stream = 3, .phase = 7};

MatrixD uniforms(std::size_t rows, std::size_t columns) {
  MatrixD u(rows, columns);
  for (Eigen::Index r = 0; r < u.rows(); ++r)
    for (Eigen::Index c = 0; c < u.cols(); ++c)
      u(r, c) = random_uniform(kKey, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return u;
}

MatrixD normals(std::size_t rows, std::size_t columns) {
  MatrixD z(rows, columns);
  for (Eigen::Index r = 0; r < z.rows(); ++r)
    for (Eigen::Index c = 0; c < z.cols(); ++c)
      z(r, c) = random_normal(kKey, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return z;
}

/// The operands of one product with its epilogue, on host and device, every one a block of rows
/// within a bigger matrix.
class Operands {
 public:
  Operands(Device& device, const ProductShape& shape, const Epilogue& epilogue)
      : shape_(shape),
        epilogue_(epilogue),
        a_(random_matrix(shape.m, shape.k, 1)),
        b_(random_matrix(shape.k, shape.n, 2, 2.0F)),
        bias_(random_matrix(epilogue.bias == BiasKind::row ? 1 : shape.m + kBiasFirst, shape.n, 3)),
        factor_(factor_of(shape, epilogue)),
        a_device_(Matrix::from_host(device, a_)),
        b_device_(Matrix::from_host(device, b_)),
        bias_device_(Matrix::from_host(device, bias_)),
        factor_device_(Matrix::from_host(device, factor_)),
        factor_rows_(factor_device_, 1, shape.m),
        out_(device, shape.m, shape.n),
        sample_(device, shape.m, shape.n),
        sample_rows_(sample_.rows()) {}

  void run(GemmBackend backend) {
    GemmOptions options = epilogue_options();
    options.backend = backend;
    gemm(a_device_, b_device_, out_.rows(), options);
  }

  /// The product as one call, the epilogue as another.
  void run_in_two() {
    gemm(a_device_, b_device_, out_.rows());
    apply_epilogue(out_.rows(), epilogue_options());
  }

  void check() const {
    const Bounded want = wanted();
    CHECK(misfit(out_.values(), want.value, want.bound) == "");
    CHECK(out_.intact());
    if (epilogue_.sampling == Sampling::none) return;
    CHECK(sample_.intact());
    if (epilogue_.sampling == Sampling::gaussian)
      check_normal();
    else
      check_bits(want);
  }

 private:
  static constexpr std::size_t kBiasFirst = 2;

  /// Values that the units can have; some are dropped where drop-out was on.
  static MatrixF factor_of(const ProductShape& shape, const Epilogue& epilogue) {
    const MatrixF values = random_matrix(shape.m + 1, shape.n, 4);
    if (epilogue.activation != Activation::centered_sigmoid_gradient) return values.cwiseAbs();
    const MatrixF units = (0.5F / epilogue.kept_share) * values;
    if (epilogue.kept_share == 1.0F) return units;
    return (random_matrix(shape.m + 1, shape.n, 5).array() > 0.0F).select(units, 0.0F);
  }

  GemmOptions epilogue_options() const {
    GemmOptions options;
    if (epilogue_.bias != BiasKind::none) options.bias = &bias_device_;
    if (epilogue_.bias == BiasKind::matrix) options.bias_first = kBiasFirst;
    options.activation = epilogue_.activation;
    if (epilogue_.activation == Activation::sigmoid_gradient ||
        epilogue_.activation == Activation::relu_gradient ||
        epilogue_.activation == Activation::centered_sigmoid_gradient)
      options.factor = &factor_rows_;
    options.kept_share = epilogue_.kept_share;
    options.sampling = epilogue_.sampling;
    if (epilogue_.sampling != Sampling::none) options.sample = &sample_rows_;
    options.temperature = epilogue_.temperature;
    options.random = kKey;
    return options;
  }

  Bounded wanted() const {
    const auto m = static_cast<Eigen::Index>(shape_.m);
    const MatrixD factor = factor_.bottomRows(m).cast<double>();
    Bounded x = reference::product(a_.cast<double>(), b_.cast<double>());
    if (epilogue_.bias == BiasKind::row) x = plus_row(x, Bounded::exact(bias_.cast<double>()));
    if (epilogue_.bias == BiasKind::matrix)
      x = x + Bounded::exact(bias_.bottomRows(m).cast<double>());
    if (epilogue_.activation == Activation::sigmoid) x = reference::sigmoid(x);
    if (epilogue_.activation == Activation::sigmoid_gradient)
      x = times(x, reference::sigmoid_gradient(Bounded::exact(factor)));
    if (epilogue_.activation == Activation::relu) x = reference::relu(x);
    if (epilogue_.activation == Activation::relu_gradient) x = reference::relu_gradient(x, factor);
    if (epilogue_.activation == Activation::centered_sigmoid) x = reference::centered_sigmoid(x);
    if (epilogue_.activation == Activation::centered_sigmoid_gradient)
      x = reference::centered_sigmoid_gradient(x, factor, double{epilogue_.kept_share});
    return x;
  }

  void check_normal() const {
    const Bounded mean = Bounded::exact(out_.values().cast<double>());
    const Bounded want =
        tempered(mean, gaussian(mean, normals(shape_.m, shape_.n)), double{epilogue_.temperature});
    CHECK(misfit(sample_.values(), want.value, want.bound) == "");
  }

  void check_bits(const Bounded& probability) const {
    const MatrixD u = uniforms(shape_.m, shape_.n);
    const MatrixD mean = out_.values().cast<double>();
    // Against the probability that the device stored there is no doubt about any bit.
    const MatrixD bits = reference::bernoulli(mean, u);
    if (epilogue_.temperature == 1.0F) {
      CHECK(sample_.values().cast<double>() == bits);
    } else {
      const Bounded want =
          tempered(Bounded::exact(mean), Bounded::exact(bits), double{epilogue_.temperature});
      CHECK(misfit(sample_.values(), want.value, want.bound) == "");
    }
    // Against the exact one only where it is as near to the draw as rounding can move it.
    const MatrixD exact_bits = reference::bernoulli(probability.value, u);
    int doubtful = 0, wrong = 0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double distance = std::abs(probability.value.data()[i] - u.data()[i]);
      if (distance <= probability.bound.data()[i])
        ++doubtful;
      else if (bits.data()[i] != exact_bits.data()[i])
        ++wrong;
    }
    CHECK(wrong == 0);
    CHECK(doubtful <= u.size() / 50);
  }

  ProductShape shape_;
  Epilogue epilogue_;
  MatrixF a_, b_, bias_, factor_;
  Matrix a_device_, b_device_, bias_device_, factor_device_;
  Rows factor_rows_;
  GuardedBlock out_, sample_;
  Rows sample_rows_;
};

void check_epilogue(Device& device, const ProductShape& shape, const Epilogue& epilogue,
                    GemmBackend backend) {
  const int bias = static_cast<int>(epilogue.bias);
  const int activation = static_cast<int>(epilogue.activation);
  const int sampling = static_cast<int>(epilogue.sampling);
  CAPTURE(shape.m);
  CAPTURE(shape.k);
  CAPTURE(shape.n);
  CAPTURE(bias);
  CAPTURE(activation);
  CAPTURE(sampling);
  CAPTURE(epilogue.temperature);
  Operands operands(device, shape, epilogue);
  operands.run(backend);
  operands.check();
}

}  // namespace

TEST_CASE("small: every bias, activation and draw of gemm's epilogue") {
  on_every_device([](Device& device) {
    // In tiles of two rows: each epilogue is compiled for itself, and these compile in a third of
    // the time.
    const Tuning usual = device.tuning();
    Tuning low = usual;
    low.product_rows = 2;
    device.set_tuning(low);
    for (const auto& epilogue : all_epilogues())
      check_epilogue(device, {13, 7, 17}, epilogue, GemmBackend::own);
    device.set_tuning(usual);
  });
}

TEST_CASE("small: the model's epilogues at odd sizes") {
  on_every_device([](Device& device) {
    for (const auto& shape : {ProductShape{1, 1, 1}, {3, 5, 3}, {5, 3, 33}})
      for (const auto& epilogue : kModelEpilogues)
        check_epilogue(device, shape, epilogue, GemmBackend::own);
  });
}

TEST_CASE("the model's epilogues at the model's sizes") {
  on_every_device([](Device& device) {
    for (const auto& shape : kModelShapes)
      for (const auto& epilogue : kModelEpilogues)
        check_epilogue(device, shape, epilogue, GemmBackend::own);
  });
}

TEST_CASE("small: temperature spreads the draws about their mean") {
  on_every_device([](Device& device) {
    for (const auto sampling : {Sampling::bernoulli, Sampling::gaussian})
      for (const float temperature : {0.0F, 0.5F, 2.0F})
        check_epilogue(device, {13, 7, 17},
                       {BiasKind::row, Activation::sigmoid, sampling, temperature},
                       GemmBackend::own);
  });
}

TEST_CASE("CLBlast with the epilogue as a kernel behind it") {
  on_every_device([](Device& device) {
    for (const auto& epilogue : every_pair())
      for (const auto& shape : {ProductShape{13, 7, 17}, {100, 190, 300}})
        check_epilogue(device, shape, epilogue, GemmBackend::clblast);
  });
}

TEST_CASE("small: the epilogue as a kernel of its own") {
  on_every_device([](Device& device) {
    for (const auto& epilogue : kModelEpilogues) {
      Operands operands(device, {13, 7, 17}, epilogue);
      operands.run_in_two();
      operands.check();
    }
  });
}

TEST_CASE("small: bits equal the reference's unless |p - u| is within 8 ulp") {
  // Bias alone, so that the probability has no error but the sigmoid's.
  constexpr std::size_t kRows = 29, kColumns = 61;
  const MatrixF x = random_matrix(kRows, kColumns, 5, 12.0F);
  const MatrixD p = reference::sigmoid(MatrixD(x.cast<double>()));
  const MatrixD u = uniforms(kRows, kColumns);
  on_every_device([&](Device& device) {
    Matrix values = Matrix::from_host(device, x);
    const Matrix sample(device, kRows, kColumns);
    const Rows sample_rows(sample);
    GemmOptions options;
    options.activation = Activation::sigmoid;
    options.sampling = Sampling::bernoulli;
    options.sample = &sample_rows;
    options.random = kKey;
    apply_epilogue(values, options);
    const MatrixF bits = sample.to_host();
    int wrong = 0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double ulp = std::ldexp(1.0, std::ilogb(p.data()[i]) - 23);
      const bool wanted = u.data()[i] < p.data()[i];
      const bool near = std::abs(p.data()[i] - u.data()[i]) <= 8.0 * ulp;
      if (bits.data()[i] != (wanted ? 1.0F : 0.0F) && !near) ++wrong;
    }
    CHECK(wrong == 0);
    CHECK(bits.sum() > 0.4F * static_cast<float>(bits.size()));
    CHECK(bits.sum() < 0.6F * static_cast<float>(bits.size()));
  });
}

}  // namespace gemm_epilogue_test
