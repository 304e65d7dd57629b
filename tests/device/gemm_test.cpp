#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/gemm.hpp"
#include "device/shapes.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/product_reference.hpp"

namespace gemm_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::misfit;

namespace {

struct Scaling {
  float alpha, beta;
};
const std::vector<Scaling> kScalings = {{1.0F, 0.0F}, {-0.7F, 0.0F}, {0.3F, 1.0F}, {1.0F, -1.3F}};

void check_gemm(Device& device, const ProductShape& shape, const Scaling& scaling,
                GemmBackend backend) {
  CAPTURE(shape.m);
  CAPTURE(shape.k);
  CAPTURE(shape.n);
  CAPTURE(scaling.alpha);
  CAPTURE(scaling.beta);
  const MatrixF a = random_matrix(shape.m, shape.k, 1);
  const MatrixF b = random_matrix(shape.k + 3, shape.n, 2);
  const MatrixF c = random_matrix(shape.m, shape.n, 3);
  const Matrix a_device = Matrix::from_host(device, a);
  const Matrix b_device = Matrix::from_host(device, b);
  const GuardedBlock out(device, shape.m, shape.n, scaling.beta == 0.0F ? MatrixF() : c);
  GemmOptions options;
  options.alpha = scaling.alpha;
  options.beta = scaling.beta;
  options.backend = backend;
  gemm(a_device, Rows(b_device, 2, shape.k), out.rows(), options);
  const auto want = reference::product(
      a.cast<double>(), b.middleRows(2, static_cast<Eigen::Index>(shape.k)).cast<double>(),
      scaling.alpha, scaling.beta, c.cast<double>());
  CHECK(misfit(out.values(), want.value, want.bound) == "");
  CHECK(out.intact());
}

void check_transposed(Device& device, const ProductShape& shape, const Scaling& scaling,
                      GemmBackend backend) {
  CAPTURE(shape.m);
  CAPTURE(shape.k);
  CAPTURE(shape.n);
  CAPTURE(scaling.alpha);
  CAPTURE(scaling.beta);
  const MatrixF a = random_matrix(shape.k + 1, shape.m, 4);
  const MatrixF b = random_matrix(shape.k + 3, shape.n, 5);
  const MatrixF c = random_matrix(shape.m, shape.n, 6);
  const Matrix a_device = Matrix::from_host(device, a);
  const Matrix b_device = Matrix::from_host(device, b);
  const GuardedBlock out(device, shape.m, shape.n, scaling.beta == 0.0F ? MatrixF() : c);
  gemm_transposed_a(Rows(a_device, 1, shape.k), Rows(b_device, 2, shape.k), out.rows(),
                    scaling.alpha, scaling.beta, backend);
  const auto k = static_cast<Eigen::Index>(shape.k);
  const auto want = reference::product(a.middleRows(1, k).transpose().cast<double>(),
                                       b.middleRows(2, k).cast<double>(), scaling.alpha,
                                       scaling.beta, c.cast<double>());
  CHECK(misfit(out.values(), want.value, want.bound) == "");
  CHECK(out.intact());
}

}  // namespace

TEST_CASE("small: gemm is within (k + 2)·u of the exact product") {
  on_every_device([](Device& device) {
    for (const auto& shape : kSmallShapes)
      for (const auto& scaling : kScalings) check_gemm(device, shape, scaling, GemmBackend::own);
  });
}

TEST_CASE("small: gemm_transposed_a is within (k + 2)·u of the exact product") {
  on_every_device([](Device& device) {
    for (const auto& shape : kSmallShapes)
      for (const auto& scaling : kScalings)
        check_transposed(device, shape, scaling, GemmBackend::own);
  });
}

TEST_CASE("gemm and gemm_transposed_a are within (k + 2)·u at the model's sizes") {
  on_every_device([](Device& device) {
    for (const auto& shape : kModelShapes)
      for (const auto& scaling : kScalings) {
        check_gemm(device, shape, scaling, GemmBackend::own);
        check_transposed(device, shape, scaling, GemmBackend::own);
      }
  });
}

TEST_CASE("CLBlast behind the same interface is within (k + 2)·u too") {
  on_every_device([](Device& device) {
    for (const auto* shapes : {&kSmallShapes, &kModelShapes})
      for (const auto& shape : *shapes)
        for (const auto& scaling : kScalings) {
          check_gemm(device, shape, scaling, GemmBackend::clblast);
          check_transposed(device, shape, scaling, GemmBackend::clblast);
        }
  });
}

TEST_CASE("the same product has the same bits every time, and one more or one fewer row leave it") {
  on_every_device([](Device& device) {
    const Matrix a = Matrix::from_host(device, random_matrix(200, 190, 7));
    const Matrix b = Matrix::from_host(device, random_matrix(190, 300, 8));
    // The many rows have their columns packed, the few have not.
    Matrix all(device, 200, 300), again(device, 200, 300), some(device, 37, 300);
    gemm(a, b, all);
    gemm(a, b, again);
    gemm(Rows(a, 11, 37), b, some);
    CHECK(all.to_host() == again.to_host());
    CHECK(all.to_host().middleRows(11, 37) == some.to_host());
  });
}

TEST_CASE("small: gemm with nothing to sum gives the bias") {
  on_every_device([](Device& device) {
    const Matrix a(device, 3, 0), b(device, 0, 5);
    const MatrixF bias = random_matrix(1, 5, 9);
    const Matrix bias_device = Matrix::from_host(device, bias);
    Matrix c(device, 3, 5);
    GemmOptions options;
    options.bias = &bias_device;
    for (const auto backend : {GemmBackend::own, GemmBackend::clblast}) {
      options.backend = backend;
      c.set_zero();
      gemm(a, b, c, options);
      CHECK(c.to_host() == bias.replicate(3, 1));
    }
  });
}

TEST_CASE("small: gemm refuses shapes that do not fit") {
  on_every_device([](Device& device) {
    const Matrix a(device, 3, 5), b(device, 5, 7), wrong_b(device, 4, 7), bias(device, 1, 6);
    const Matrix c(device, 3, 7), wrong_c(device, 3, 8);
    const Rows sample(c);
    CHECK_THROWS_AS(gemm(a, wrong_b, c), ShapeError);
    CHECK_THROWS_AS(gemm(a, b, wrong_c), ShapeError);
    CHECK_THROWS_AS(gemm_transposed_a(a, b, c), ShapeError);
    GemmOptions with_bias, without_sample, without_sampling, without_factor;
    with_bias.bias = &bias;
    without_sample.sampling = Sampling::bernoulli;
    without_sampling.sample = &sample;
    without_factor.activation = Activation::sigmoid_gradient;
    for (const auto* options : {&with_bias, &without_sample, &without_sampling, &without_factor})
      CHECK_THROWS_AS(gemm(a, b, c, *options), ShapeError);
    CHECK_THROWS_AS(Rows(a, 2, 2), ShapeError);
  });
}

TEST_CASE("small: gemm counts A's columns exactly, whatever their padding") {
  on_every_device([](Device& device) {
    // 17 columns are padded to 32; 2 rows of B are neither.
    const Matrix a(device, 3, 17), b(device, 2, 7), c(device, 3, 7);
    CHECK_THROWS_AS(gemm(a, b, c), ShapeError);
  });
}

}  // namespace gemm_test
