#include "device/optimizer.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/update_reference.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using reference::gamma_n;
using reference::kDivisionError;
using reference::kRoundoff;
using reference::kSmallestNormal;
using reference::kSqrtError;
using reference::misfit;

namespace {

/// Parameters of one matrix, with their optimizer.
struct OneMatrix {
  OneMatrix(Device& device, const MatrixF& values, OptimizerKind kind, bool is_weight = true)
      : parameters(device, {{.name = "W",
                             .rows = static_cast<std::size_t>(values.rows()),
                             .columns = static_cast<std::size_t>(values.cols()),
                             .is_weight = is_weight}}),
        optimizer(parameters, kind) {
    parameters.upload("W", values);
  }
  /// What the optimizer keeps of it.
  void set_state(std::size_t number, const MatrixF& values) {
    const Matrix state(parameters.device(), 1, parameters.all().columns());
    Parameters one = parameters.in(state);
    one.upload("W", values);
    optimizer.states().copy_rows_from(state, 0, 1, number);
  }
  MatrixF state(std::size_t number) {
    Matrix one(parameters.device(), 1, parameters.all().columns());
    one.copy_rows_from(optimizer.states(), number, 1, 0);
    CHECK(padding_is_zero(parameters.in(one).matrix("W")));
    return parameters.in(one).to_host("W");
  }
  void set_gradient(const MatrixF& values) {
    parameters.in(optimizer.gradients()).upload("W", values);
  }
  void update(const UpdateRule& rule, int step = 1, const Matrix* scale = nullptr) {
    for (int i = 0; i < step; ++i) optimizer.next_step();
    optimizer.update([&rule](const ParameterShape&) { return rule; }, scale);
    CHECK(padding_is_zero(parameters.matrix("W")));
  }
  MatrixF values() const { return parameters.to_host("W"); }

  Parameters parameters;
  Optimizer optimizer;
};

void check_momentum(Device& device, std::size_t rows, std::size_t columns, const UpdateRule& rule) {
  CAPTURE(rows);
  CAPTURE(columns);
  CAPTURE(rule.rate);
  const MatrixF parameter = random_matrix(rows, columns, 1),
                velocity = random_matrix(rows, columns, 2);
  const MatrixF gradient = random_matrix(rows, columns, 3, 10.0F);
  OneMatrix device_side(device, parameter, OptimizerKind::momentum);
  device_side.set_state(0, velocity);
  device_side.set_gradient(gradient);
  device_side.update(rule);

  MatrixD want_parameter = parameter.cast<double>(), want_velocity = velocity.cast<double>();
  reference::momentum_update(want_parameter, want_velocity, -gradient.cast<double>(), rule);
  const MatrixD pull = gradient.cwiseAbs().cast<double>() +
                       double{rule.weight_decay} * parameter.cwiseAbs().cast<double>();
  const MatrixD magnitude =
      double{rule.momentum} * velocity.cwiseAbs().cast<double>() + double{rule.rate} * pull;
  // decay's product, the difference, the rate's product, the sum
  const MatrixD velocity_bound = gamma_n(4) * magnitude;
  CHECK(misfit(device_side.state(0), want_velocity, velocity_bound) == "");
  const MatrixD parameter_bound =
      (1.0 + kRoundoff) * velocity_bound + kRoundoff * want_parameter.cwiseAbs();
  CHECK(misfit(device_side.values(), want_parameter, parameter_bound) == "");
}

void check_adam(Device& device, std::size_t rows, std::size_t columns, int step,
                float weight_decay) {
  CAPTURE(rows);
  CAPTURE(columns);
  CAPTURE(step);
  const UpdateRule rule = UpdateRule::adam(1e-3F, weight_decay);
  const MatrixF parameter = random_matrix(rows, columns, 1);
  const MatrixF mean = random_matrix(rows, columns, 2), gradient = random_matrix(rows, columns, 3);
  const MatrixF square = random_matrix(rows, columns, 4).cwiseAbs();
  OneMatrix device_side(device, parameter, OptimizerKind::adam);
  device_side.set_state(0, mean);
  device_side.set_state(1, square);
  device_side.set_gradient(gradient);
  device_side.update(rule, step);

  MatrixD want = parameter.cast<double>(), want_mean = mean.cast<double>();
  MatrixD want_square = square.cast<double>();
  reference::adam_update(want, want_mean, want_square, gradient.cast<double>(), rule, step);

  // 1 − β (exact for β in [½, 1]), two products and their sum; g² has one product more.
  const double beta1 = rule.momentum, correction1 = 1.0 - std::pow(beta1, step);
  const double correction2 = 1.0 - std::pow(double{rule.beta2}, step);
  const MatrixD mean_bound = gamma_n(3) * (beta1 * mean.cwiseAbs().cast<double>() +
                                           (1.0 - beta1) * gradient.cwiseAbs().cast<double>());
  const MatrixD square_bound = gamma_n(4) * want_square;
  CHECK(misfit(device_side.state(0), want_mean, mean_bound) == "");
  CHECK(misfit(device_side.state(1), want_square, square_bound) == "");

  const MatrixD divisor = (want_square / correction2).cwiseSqrt().array() + double{rule.epsilon};
  const double divisor_error = (4.0 + kDivisionError + 1.0) / 2.0 + kSqrtError + 1.0;
  const MatrixD direction = (want_mean / correction1).cwiseQuotient(divisor);
  const MatrixD direction_bound =
      (1.0 + gamma_n(30)) * (mean_bound / correction1).cwiseQuotient(divisor) +
      gamma_n(2.0 * kDivisionError + 1.0 + divisor_error) * direction.cwiseAbs();
  const MatrixD pull =
      direction.cwiseAbs() + double{weight_decay} * parameter.cwiseAbs().cast<double>();
  const MatrixD bound =
      double{rule.rate} * ((1.0 + gamma_n(3)) * direction_bound + gamma_n(3) * pull) +
      kRoundoff * want.cwiseAbs();
  CHECK(misfit(device_side.values(), want, bound) == "");
}

const UpdateRule kRules[] = {{.rate = 1e-3F, .momentum = 0.0F, .weight_decay = 0.0F},
                             {.rate = 1e-3F, .momentum = 0.9F, .weight_decay = 2e-4F},
                             {.rate = 0.1F, .momentum = 0.5F, .weight_decay = 0.1F}};

}  // namespace

TEST_CASE("small: momentum with weight decay") {
  on_every_device([](Device& device) {
    for (const auto& rule : kRules) {
      check_momentum(device, 1, 1, rule);
      check_momentum(device, 3, 3, rule);
      check_momentum(device, 7, 17, rule);
    }
  });
}

TEST_CASE("momentum with weight decay at the model's sizes") {
  on_every_device([](Device& device) {
    for (const auto& rule : kRules) {
      check_momentum(device, 96, 300, rule);
      check_momentum(device, 5 * 192, 300, rule);
      check_momentum(device, 1, 300, rule);
    }
  });
}

TEST_CASE("small: Adam with decoupled weight decay") {
  on_every_device([](Device& device) {
    for (const int step : {1, 2, 1000})
      for (const float decay : {0.0F, 0.01F}) {
        check_adam(device, 1, 1, step, decay);
        check_adam(device, 3, 3, step, decay);
        check_adam(device, 7, 17, step, decay);
      }
  });
}

TEST_CASE("Adam with decoupled weight decay at the model's sizes") {
  on_every_device([](Device& device) {
    for (const int step : {1, 500}) check_adam(device, 300, 150, step, 2e-4F);
  });
}

TEST_CASE("small: Adam leaves a parameter without gradient where it is") {
  on_every_device([](Device& device) {
    const MatrixF before = random_matrix(3, 5, 5);
    OneMatrix device_side(device, before, OptimizerKind::adam);
    device_side.set_gradient(MatrixF::Zero(3, 5));
    for (int step = 1; step <= 3; ++step) device_side.update(UpdateRule::adam());
    CHECK(device_side.values() == before);
  });
}

TEST_CASE("small: the optimizer none leaves parameters where they are") {
  on_every_device([](Device& device) {
    const MatrixF before = random_matrix(3, 5, 5);
    OneMatrix device_side(device, before, OptimizerKind::none);
    device_side.set_gradient(random_matrix(3, 5, 6));
    device_side.update(UpdateRule{.rate = 1.0F});
    CHECK(device_side.values() == before);
    CHECK(device_side.optimizer.states().empty());
  });
}

TEST_CASE("small: every parameter moves by its own gradient and rule") {
  on_every_device([](Device& device) {
    for (const OptimizerKind kind : {OptimizerKind::momentum, OptimizerKind::adam}) {
      Parameters parameters(device, {{.name = "W", .rows = 3, .columns = 5},
                                     {.name = "A", .rows = 0, .columns = 5},
                                     {.name = "b", .rows = 1, .columns = 17, .is_weight = false}});
      const MatrixF W = random_matrix(3, 5, 1), b = random_matrix(1, 17, 2);
      const MatrixF gradient_W = random_matrix(3, 5, 3), gradient_b = random_matrix(1, 17, 4);
      parameters.upload("W", W);
      parameters.upload("b", b);
      Optimizer optimizer(parameters, kind);
      Parameters gradients = parameters.in(optimizer.gradients());
      gradients.upload("W", gradient_W);
      gradients.upload("b", gradient_b);
      optimizer.next_step();
      optimizer.update([](const ParameterShape& shape) {
        return UpdateRule{.rate = shape.is_weight ? 0.5F : 0.25F};
      });
      // Momentum 0 makes Adam's first step the gradient's sign.
      const auto moved = [&](const MatrixF& from, const MatrixF& gradient, float rate) {
        const MatrixF step = kind == OptimizerKind::adam ? MatrixF(gradient.cwiseSign()) : gradient;
        return MatrixF(from - rate * step);
      };
      CHECK((parameters.to_host("W") - moved(W, gradient_W, 0.5F)).cwiseAbs().maxCoeff() < 1e-4F);
      CHECK((parameters.to_host("b") - moved(b, gradient_b, 0.25F)).cwiseAbs().maxCoeff() < 1e-4F);
    }
  });
}

TEST_CASE(
    "small: a long gradient is cut to the length that is allowed, a short one is left alone") {
  on_every_device([](Device& device) {
    const MatrixF first = random_matrix(7, 17, 1), second = random_matrix(1, 3, 2);
    const Parameters parameters(device, {{.name = "first", .rows = 7, .columns = 17},
                                         {.name = "second", .rows = 1, .columns = 3}});
    const Matrix gradients = Matrix::like(parameters.all());
    Parameters both = parameters.in(gradients);
    both.upload("first", first);
    both.upload("second", second);
    const double length =
        std::sqrt(first.cast<double>().squaredNorm() + second.cast<double>().squaredNorm());
    GradientLimit limit(parameters);
    limit.measure(gradients, static_cast<float>(0.5 * length));
    const double scale = static_cast<double>(limit.scale().to_host()(0));
    // A sum of squares of so many terms under a root, the root, the division, and 0.5·length
    // itself.
    const double terms = static_cast<double>(first.size() + second.size());
    const double relative = gamma_n(terms / 2.0 + kSqrtError + kDivisionError + 3.0);
    CHECK(std::abs(scale - 0.5) <= 0.5 * relative);
    limit.measure(gradients, static_cast<float>(2.0 * length));
    CHECK(limit.scale().to_host()(0) == 1.0F);
    CHECK_THROWS_AS(limit.measure(Matrix(device, 1, 16), 1.0F), ShapeError);

    // Adam with a scale is Adam on the scaled gradient, to the bit.
    const float half = 0.375F;
    const auto run = [&](const MatrixF& gradient, const Matrix* with) {
      OneMatrix device_side(device, random_matrix(7, 17, 3), OptimizerKind::adam);
      device_side.set_gradient(gradient);
      device_side.update(UpdateRule::adam(), 3, with);
      return device_side.values();
    };
    const Matrix given = Matrix::from_host(device, MatrixF::Constant(1, 1, half));
    CHECK(run(first, &given) == run(half * first, nullptr));
  });
}

TEST_CASE("small: a moving average goes the given share of the way") {
  on_every_device([](Device& device) {
    const MatrixF before = random_matrix(5, 19, 1), parameter = random_matrix(5, 19, 2);
    Matrix average = Matrix::from_host(device, before);
    average_update(average, Matrix::from_host(device, parameter), 0.3F);
    const MatrixD from = before.cast<double>(), to = parameter.cast<double>();
    const MatrixD want = from + double{0.3F} * (to - from);
    // The difference, then one fma.
    const MatrixD bound = gamma_n(1) * 0.3 * (to - from).cwiseAbs() + kRoundoff * want.cwiseAbs();
    CHECK(misfit(average.to_host(), want, MatrixD((1.0 + gamma_n(2)) * bound)) == "");
    CHECK(padding_is_zero(average));
  });
}

TEST_CASE("small: a moving average refuses shapes that differ") {
  on_every_device([](Device& device) {
    Matrix x(device, 3, 5);
    CHECK_THROWS_AS(average_update(x, Matrix(device, 5, 3), 0.5F), ShapeError);
  });
}
