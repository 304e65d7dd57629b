#pragma once

#include <functional>

#include "device/program.hpp"
#include "device/training_state.hpp"
#include "mcdbn/device/parameters.hpp"

namespace mcdbn {

/// How parameters move along the gradient of the loss (optimizer.clh). `none` only keeps the
/// gradient.
enum class OptimizerKind { none, momentum, adam };

/// How one matrix is updated in a step.
struct UpdateRule {
  float rate = 1e-3F;
  float momentum = 0.0F;      ///< kept of the velocity; Adam's β1, the same in every step
  float weight_decay = 0.0F;  ///< Adam's is decoupled; times the rate in both
  float beta2 = 0.999F;       ///< Adam's, the same in every step
  float epsilon = 1e-8F;      ///< Adam's
  float l1 = 0.0F;            ///< pulls towards zero, whatever the size; times the rate in both

  /// With β1 = 0.9 (Kingma and Ba 2015).
  static UpdateRule adam(float rate = 1e-3F, float weight_decay = 0.0F) {
    return {rate, 0.9F, weight_decay};
  }
  /// For biases.
  UpdateRule without_decay() const {
    UpdateRule rule = *this;
    rule.weight_decay = rule.l1 = 0.0F;
    return rule;
  }
};

/// SGD with momentum (eq 36), or Adam, on all parameters of a machine:
/// velocity ← momentum·velocity − rate·(gradient + decay·parameter); parameter += velocity.
/// Kernels that make a gradient and apply it at once are built with define() and take the other
/// arguments from here; where the gradient is made elsewhere, update() applies it.
class Optimizer {
 public:
  Optimizer(const Parameters& parameters, OptimizerKind kind);

  OptimizerKind kind() const { return kind_; }
  const Parameters& parameters() const { return parameters_; }
  /// Value of -DOPTIMIZER. @param with_l1 for rules that have some
  const char* define(bool with_l1 = false) const;
  /// A new step begins: Adam's corrections count them.
  void next_step() { ++steps_; }
  /// The kernels' `rule` at this step.
  cl_float8 argument(const UpdateRule& rule) const;
  /// [1 x floats]; without elements before gradients() was asked for by someone who fills it.
  Matrix& gradients();
  /// Buffers for a kernel's arguments: any buffer where the kernel does not use it.
  const cl::Buffer& gradient_buffer();
  const cl::Buffer& state_buffer() const;
  /// [states x floats]: the velocity, or the mean and the square; none: empty.
  Matrix& states() { return states_; }
  /// State that is kept from step to step; the parameters belong to their machine.
  void visit_state(TrainingState& state);
  /// Floats of one block of states.
  int size() const;

  /// Every parameter by its gradient in gradients(); biases without the rule's decay.
  /// @param rule_of what an entry takes, or one rule for all  @param gradient_scale [1 x 1] what
  /// gradients are multiplied
  ///        with first
  void update(const std::function<UpdateRule(const ParameterShape&)>& rule_of,
              const Matrix* gradient_scale = nullptr);
  void update(const UpdateRule& rule, const Matrix* gradient_scale = nullptr) {
    update([&rule](const ParameterShape&) { return rule; }, gradient_scale);
  }

 private:
  Parameters parameters_;
  OptimizerKind kind_;
  int steps_ = 0;
  Matrix gradients_, states_;  // [1 x floats], [states x floats]
};

/// The scale that brings a gradient to a length of at most `longest`; all of it stays on the
/// device, and the sum has a fixed order.
class GradientLimit {
 public:
  explicit GradientLimit(const Parameters& parameters);
  /// @param gradients [1 x floats]
  void measure(const Matrix& gradients, float longest);
  const Matrix& scale() const { return scale_; }  ///< [1 x 1]

 private:
  Parameters parameters_;
  std::size_t parts_;  ///< of an entry, each summed up by a work-item
  Matrix squares_, scale_;
};

/// Fast weights (Tieleman and Hinton 2009): fast ← kept·fast − rate·gradient; sum = parameter +
/// fast. @param fast, sum, gradients [1 x floats], laid out as the parameters are
/// @param rate_of what an entry takes  @throws ShapeError
void fast_update(Matrix& fast, Matrix& sum, const Parameters& parameters, const Matrix& gradients,
                 float kept, const std::function<float(const ParameterShape&)>& rate_of);

/// average += share · (parameter − average): a moving average of what training passes through.
/// Both of one shape. @throws ShapeError
void average_update(Matrix& average, const Matrix& parameters, float share);

}  // namespace mcdbn
