#include "mcdbn/device/update.hpp"

#include <cmath>

#include "mcdbn/device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

LaunchSize elements(const Matrix& matrix) {
  return {{matrix.element_count() / static_cast<std::size_t>(vector_width(matrix.device())), 1}};
}

cl::Kernel& update_kernel(Device& device, const char* name) {
  return device.programs().kernel("update.cl", name, {{"VEC", vector_width(device)}});
}

}  // namespace

void momentum_update(Matrix& parameter, Matrix& velocity, const Matrix& gradient,
                     const MomentumRule& rule) {
  require(same_shape(parameter, velocity) && same_shape(parameter, gradient),
          "update: shapes differ");
  if (parameter.empty()) return;
  Device& device = parameter.device();
  launch(device, update_kernel(device, "momentum_update"), elements(parameter), parameter.buffer(),
         velocity.buffer(), gradient.buffer(), rule.rate, rule.momentum, rule.weight_decay);
}

void adam_update(Matrix& parameter, Matrix& mean, Matrix& square, const Matrix& gradient,
                 const AdamRule& rule, int step) {
  require(same_shape(parameter, mean) && same_shape(parameter, square) &&
              same_shape(parameter, gradient),
          "update: shapes differ");
  if (parameter.empty()) return;
  Device& device = parameter.device();
  const auto correction = [step](float beta) {
    return static_cast<float>(1.0 - std::pow(static_cast<double>(beta), step));
  };
  launch(device, update_kernel(device, "adam_update"), elements(parameter), parameter.buffer(),
         mean.buffer(), square.buffer(), gradient.buffer(), rule.rate, rule.beta1, rule.beta2,
         rule.epsilon, rule.weight_decay, correction(rule.beta1), correction(rule.beta2));
}

void average_update(Matrix& average, const Matrix& parameter, float share) {
  require(same_shape(average, parameter), "average: shapes differ");
  if (average.empty()) return;
  Device& device = average.device();
  launch(device, update_kernel(device, "average_update"), elements(average), average.buffer(),
         parameter.buffer(), share);
}

}  // namespace mcdbn
