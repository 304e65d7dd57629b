#include "device/updates.hpp"

#include <cmath>

#include "device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

LaunchSize elements(const Matrix& matrix) {
  return {{matrix.element_count() / static_cast<std::size_t>(vector_width(matrix.device())), 1}};
}

cl::Kernel& update_kernel(Device& device, const char* name, Defines defines = {}) {
  defines["VEC"] = vector_width(device);
  return device.programs().kernel("optimizers.cl", name, defines);
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
                 const AdamRule& rule, int step, const Matrix* gradient_scale) {
  require(same_shape(parameter, mean) && same_shape(parameter, square) &&
              same_shape(parameter, gradient),
          "update: shapes differ");
  if (parameter.empty()) return;
  Device& device = parameter.device();
  const auto correction = [step](float beta) {
    return static_cast<float>(1.0 - std::pow(static_cast<double>(beta), step));
  };
  const auto run = [&](cl::Kernel& kernel, const auto&... scale) {
    launch(device, kernel, elements(parameter), parameter.buffer(), mean.buffer(), square.buffer(),
           gradient.buffer(), rule.rate, rule.beta1, rule.beta2, rule.epsilon, rule.weight_decay,
           correction(rule.beta1), correction(rule.beta2), scale...);
  };
  if (gradient_scale)
    run(update_kernel(device, "adam_update", {{"SCALED", 1}}), gradient_scale->buffer());
  else
    run(update_kernel(device, "adam_update"));
}

GradientLimit::GradientLimit(Device& device, std::size_t matrices)
    : matrices_(matrices), squares_(device, 1, kParts * matrices), scale_(device, 1, 1) {}

void GradientLimit::measure(const std::vector<const Matrix*>& gradients, float longest) {
  require(gradients.size() == matrices_, "gradient limit: another number of matrices");
  Device& device = scale_.device();
  int first = 0;
  for (const Matrix* gradient : gradients) {
    const std::size_t vectors =
        gradient->element_count() / static_cast<std::size_t>(vector_width(device));
    launch(device, update_kernel(device, "sum_squares"), {{kParts, 1}}, gradient->buffer(),
           to_int(vectors), squares_.buffer(), first);
    first += to_int(kParts);
  }
  launch(device, update_kernel(device, "limit_scale"), {}, squares_.buffer(), first, longest,
         scale_.buffer());
}

void average_update(Matrix& average, const Matrix& parameter, float share) {
  require(same_shape(average, parameter), "average: shapes differ");
  if (average.empty()) return;
  Device& device = average.device();
  launch(device, update_kernel(device, "average_update"), elements(average), average.buffer(),
         parameter.buffer(), share);
}

}  // namespace mcdbn
