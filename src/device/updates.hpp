#pragma once

#include <vector>

#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

/// velocity ← momentum·velocity + rate·(gradient − decay·parameter); parameter += velocity.
/// `gradient` points uphill (eq 36). All [rows x columns] alike. @throws ShapeError
struct MomentumRule {
  float rate = 1e-3F;
  float momentum = 0.0F;
  float weight_decay = 0.0F;
};
void momentum_update(Matrix& parameter, Matrix& velocity, const Matrix& gradient,
                     const MomentumRule& rule);

/// Adam (Kingma and Ba 2015) with decoupled weight decay. `gradient` is that of the loss; `step`
/// counts from 1.
struct AdamRule {
  float rate = 1e-3F;
  float beta1 = 0.9F;
  float beta2 = 0.999F;
  float epsilon = 1e-8F;
  float weight_decay = 0.0F;
};
/// @param gradient_scale [1 x 1] if given, what the gradient is multiplied with first
void adam_update(Matrix& parameter, Matrix& mean, Matrix& square, const Matrix& gradient,
                 const AdamRule& rule, int step, const Matrix* gradient_scale = nullptr);

/// The scale that brings a gradient of many matrices to a length of at most `longest`; all of it
/// stays on the device, and the sum has a fixed order.
class GradientLimit {
 public:
  GradientLimit(Device& device, std::size_t matrices);
  /// @throws ShapeError if there are not as many as were said
  void measure(const std::vector<const Matrix*>& gradients, float longest);
  const Matrix& scale() const { return scale_; }  ///< [1 x 1]

 private:
  static constexpr std::size_t kParts = 64;
  std::size_t matrices_;
  Matrix squares_, scale_;
};

/// average += share · (parameter − average): a moving average of what training passes through.
void average_update(Matrix& average, const Matrix& parameter, float share);

}  // namespace mcdbn
