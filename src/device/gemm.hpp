#pragma once

#include "device/program.hpp"
#include "mcdbn/base/random.hpp"
#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

enum class Activation {
  none,
  sigmoid,           ///< eq 8
  sigmoid_gradient,  ///< times y·(1 − y) of GemmOptions::factor: back-propagation through a sigmoid
  relu,              ///< the positive part
  relu_gradient,     ///< zero where GemmOptions::factor is not positive
  centered_sigmoid,           ///< sigmoid − ½
  centered_sigmoid_gradient,  ///< times ¼ − y², y after drop-out: see GemmOptions::kept_share
};
/// Draws of units. concrete is a Bernoulli draw's smooth relaxation, σ(logit p + logit u) for a
/// uniform u (Maddison et al. 2017).
enum class Sampling { none, bernoulli, gaussian, concrete };
/// Who multiplies: our register-tiled kernel, or CLBlast followed by the epilogue as a kernel;
/// tuned: whichever Device::tuning() names for a product of that size. Rows of A that overlap are
/// always ours.
enum class GemmBackend { own, clblast, tuned };

/// What happens to a product before it is stored: f(alpha·A·B + beta·C + bias), and a draw from it.
struct GemmOptions {
  float alpha = 1.0F;
  float beta = 0.0F;
  const Matrix* bias = nullptr;  ///< [1 x n], or a row each (dynamic biases, eq 16 and 17)
  std::size_t bias_first = 0;    ///< first row of a bias with a row each
  Activation activation = Activation::none;
  const Rows* factor = nullptr;  ///< y for the gradients, shaped like C
  Sampling sampling = Sampling::none;
  const Rows* sample = nullptr;  ///< where the draws go, shaped like C
  float kept_share = 1.0F;       ///< of drop-out on `factor`, for centered_sigmoid_gradient
  float temperature = 1.0F;      ///< sample = mean + temperature · (draw − mean)
  RandomKey random;
  GemmBackend backend = GemmBackend::tuned;
};

/// What epilogue.clh is built with: BIAS, ACTIVATION, SAMPLE.
Defines epilogue_defines(const GemmOptions& options);

/// C = f(alpha·A·B + beta·C + bias). Enqueues and returns.
/// @param a [m x k], possibly indexed  @param b [k x n]  @param c [m x n], not indexed
/// @throws ShapeError, DeviceError
void gemm(const Rows& a, const Rows& b, const Rows& c, const GemmOptions& options = {});

/// C = alpha·Aᵀ·B + beta·C: the statistics of eq 37 to 39.
/// @param a [k x m], possibly indexed  @param b [k x n]  @param c [m x n]
void gemm_transposed_a(const Rows& a, const Rows& b, const Rows& c, float alpha = 1.0F,
                       float beta = 0.0F, GemmBackend backend = GemmBackend::tuned);

}  // namespace mcdbn
