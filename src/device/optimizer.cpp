#include "device/optimizer.hpp"

#include <algorithm>
#include <cmath>

#include "device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

std::size_t states_of(OptimizerKind kind) {
  return kind == OptimizerKind::adam ? 2 : kind == OptimizerKind::momentum ? 1 : 0;
}

std::size_t vectors_of(const Device& device, std::size_t floats) {
  return floats / static_cast<std::size_t>(vector_width(device));
}

/// Work-items that sum up an entry's squares.
std::size_t square_parts(const Device& device) {
  return device.info().is_gpu ? 1024 : 64;
}

/// Work-items that add up the parts.
std::size_t limit_group(const Device& device) {
  const DeviceInfo& info = device.info();
  if (!info.is_gpu) return 1;
  return std::min({std::size_t{256}, info.largest_group, info.largest_group_sides[0]});
}

cl::Kernel& optimizer_kernel(Device& device, const char* name, Defines defines = {}) {
  defines["VEC"] = vector_width(device);
  return device.programs().kernel("optimizer.cl", name, defines);
}

}  // namespace

Optimizer::Optimizer(const Parameters& parameters, OptimizerKind kind)
    : parameters_(parameters), kind_(kind) {
  if (states_of(kind) > 0)
    states_ = Matrix(parameters.device(), states_of(kind), parameters.all().columns());
}

const char* Optimizer::define(bool with_l1) const {
  switch (kind_) {
    case OptimizerKind::momentum:
      return with_l1 ? "momentum_l1" : "momentum";
    case OptimizerKind::adam:
      return with_l1 ? "adam_l1" : "adam";
    default:
      return "none";
  }
}

cl_float8 Optimizer::argument(const UpdateRule& rule) const {
  const auto correction_of = [&](float beta) {
    return static_cast<float>(1.0 - std::pow(static_cast<double>(beta), steps_));
  };
  return {{rule.rate, rule.momentum, rule.weight_decay, rule.beta2, rule.epsilon,
           correction_of(rule.momentum), correction_of(rule.beta2), rule.l1}};
}

Matrix& Optimizer::gradients() {
  if (gradients_.empty()) gradients_ = Matrix::like(parameters_.all());
  return gradients_;
}

const cl::Buffer& Optimizer::gradient_buffer() {
  return kind_ == OptimizerKind::none ? gradients().buffer() : parameters_.all().buffer();
}

const cl::Buffer& Optimizer::state_buffer() const {
  return states_.empty() ? parameters_.all().buffer() : states_.buffer();
}

void Optimizer::visit_state(TrainingState& state) {
  state.number("optimizer.steps", steps_);
  if (!states_.empty()) state.matrix("optimizer", states_);
}

int Optimizer::size() const {
  return to_int(parameters_.all().stride());
}

void Optimizer::update(const std::function<UpdateRule(const ParameterShape&)>& rule_of,
                       const Matrix* gradient_scale) {
  if (kind_ == OptimizerKind::none) return;
  Device& device = parameters_.device();
  for (const Parameters::Entry& entry : parameters_.entries()) {
    if (entry.floats() == 0) continue;
    const LaunchSize work{{vectors_of(device, entry.floats()), 1}};
    const UpdateRule rule = rule_of(entry);
    const cl_float8 taken = argument(entry.is_weight ? rule : rule.without_decay());
    const char* optimizer = define(entry.is_weight && rule.l1 > 0.0F);
    const auto run = [&](cl::Kernel& kernel, const auto&... scale) {
      launch(device, kernel, work, parameters_.all().buffer(), gradients().buffer(), state_buffer(),
             size(), to_int(entry.first), taken, scale...);
    };
    if (gradient_scale)
      run(optimizer_kernel(device, "update_parameters", {{"OPTIMIZER", optimizer}, {"SCALED", 1}}),
          gradient_scale->buffer());
    else
      run(optimizer_kernel(device, "update_parameters", {{"OPTIMIZER", optimizer}}));
  }
}

GradientLimit::GradientLimit(const Parameters& parameters)
    : parameters_(parameters),
      parts_(square_parts(parameters.device())),
      squares_(parameters.device(), 1, parts_ * parameters.entries().size()),
      scale_(parameters.device(), 1, 1) {}

void GradientLimit::measure(const Matrix& gradients, float longest) {
  require(same_shape(gradients, parameters_.all()), "gradient limit: shapes differ");
  Device& device = scale_.device();
  int slot = 0;
  for (const Parameters::Entry& entry : parameters_.entries()) {
    launch(device, optimizer_kernel(device, "sum_squares"), {{parts_, 1}}, gradients.buffer(),
           to_int(entry.first), to_int(vectors_of(device, entry.floats())), squares_.buffer(),
           slot);
    slot += to_int(parts_);
  }
  const std::size_t group = limit_group(device);
  launch(device, optimizer_kernel(device, "limit_scale", {{"GROUP", to_int(group)}}),
         {{group, 1}, {group, 1}}, squares_.buffer(), slot, longest, scale_.buffer());
}

void fast_update(Matrix& fast, Matrix& sum, const Parameters& parameters, const Matrix& gradients,
                 float kept, const std::function<float(const ParameterShape&)>& rate_of) {
  for (const Matrix* other : {static_cast<const Matrix*>(&sum), &parameters.all(), &gradients})
    require(same_shape(fast, *other), "fast weights: shapes differ");
  Device& device = fast.device();
  for (const Parameters::Entry& entry : parameters.entries())
    if (entry.floats() > 0)
      launch(device, optimizer_kernel(device, "fast_update"),
             {{vectors_of(device, entry.floats()), 1}}, fast.buffer(), sum.buffer(),
             parameters.all().buffer(), gradients.buffer(), to_int(entry.first), kept,
             rate_of(entry));
}

void average_update(Matrix& average, const Matrix& parameters, float share) {
  require(same_shape(average, parameters), "average: shapes differ");
  if (average.empty()) return;
  Device& device = average.device();
  launch(device, optimizer_kernel(device, "average_update"),
         {{vectors_of(device, average.element_count()), 1}}, average.buffer(), parameters.buffer(),
         share);
}

}  // namespace mcdbn
