#include "comparison/lbfgs.hpp"

#include <algorithm>
#include <deque>

#include "base/interruption.hpp"

namespace mcdbn {
namespace {

using Eigen::VectorXd;

/// A recent step: the changes of x and of the gradient.
struct Step {
  VectorXd x, gradient;
  double curvature;  ///< x·gradient
};

/// −H·gradient, H the inverse Hessian that the steps make (two-loop recursion).
VectorXd downhill(const std::deque<Step>& steps, const VectorXd& gradient) {
  VectorXd direction = -gradient;
  if (steps.empty()) return direction / std::max(1.0, gradient.norm());
  std::vector<double> shares;  // of the last step first
  std::for_each(steps.rbegin(), steps.rend(), [&](const Step& step) {
    shares.push_back(step.x.dot(direction) / step.curvature);
    direction -= shares.back() * step.gradient;
  });
  direction *= steps.back().curvature / steps.back().gradient.squaredNorm();
  auto share = shares.rbegin();
  for (const Step& step : steps)
    direction += (*share++ - step.gradient.dot(direction) / step.curvature) * step.x;
  return direction;
}

}  // namespace

VectorXd minimize_lbfgs(const DifferentiableFunction& function, VectorXd start,
                        const LbfgsSettings& settings) {
  constexpr double kEnough = 1e-4;
  constexpr int kHalvings = 30;
  VectorXd x = std::move(start), gradient(x.size()), next_gradient(x.size());
  double value = function(x, gradient);
  std::deque<Step> steps;
  for (std::size_t i = 0; i < settings.steps; ++i) {
    check_interruption();
    if (!(gradient.norm() > settings.tolerance * std::max(1.0, x.norm()))) break;
    VectorXd direction = downhill(steps, gradient);
    double slope = direction.dot(gradient);
    if (!(slope < 0)) {  // rounding; the gradient itself leads down
      steps.clear();
      direction = downhill(steps, gradient);
      slope = direction.dot(gradient);
    }
    double length = 1;
    VectorXd next = x + direction;
    double next_value = function(next, next_gradient);
    for (int k = 0; k < kHalvings && !(next_value <= value + kEnough * length * slope); ++k) {
      length /= 2;
      next = x + length * direction;
      next_value = function(next, next_gradient);
    }
    if (!(next_value < value)) break;
    Step step{next - x, next_gradient - gradient, 0};
    step.curvature = step.x.dot(step.gradient);
    if (step.curvature > 1e-12 * step.x.norm() * step.gradient.norm()) {
      steps.push_back(std::move(step));
      if (steps.size() > settings.history) steps.pop_front();
    }
    x.swap(next);
    gradient.swap(next_gradient);
    value = next_value;
  }
  return x;
}

}  // namespace mcdbn
