#include "device/optimizer.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/update_error_bound.hpp"
#include "reference/update_reference.hpp"

namespace optimizer_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::exact;

namespace {

void check_within(const MatrixF& got, const Bounded& want) {
  CHECK(reference::misfit(got, want.value, want.bound) == "");
}

/// The bounded update computes what the plain one computes.
void check_value(const Bounded& bounded, const MatrixD& plain) {
  CHECK((bounded.value - plain).cwiseAbs().maxCoeff() <=
        1e-14 * std::max(1.0, plain.cwiseAbs().maxCoeff()));
}

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

  Bounded want = exact(parameter), want_velocity = exact(velocity);
  reference::bounded_momentum_update(want, want_velocity, -exact(gradient), rule);
  check_within(device_side.state(0), want_velocity);
  check_within(device_side.values(), want);

  MatrixD plain = parameter.cast<double>(), plain_velocity = velocity.cast<double>();
  reference::momentum_update(plain, plain_velocity, -gradient.cast<double>(), rule);
  check_value(want, plain);
  check_value(want_velocity, plain_velocity);
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

  Bounded want = exact(parameter), want_mean = exact(mean), want_square = exact(square);
  reference::bounded_adam_update(want, want_mean, want_square, exact(gradient), rule, step);
  check_within(device_side.state(0), want_mean);
  check_within(device_side.state(1), want_square);
  check_within(device_side.values(), want);

  MatrixD plain = parameter.cast<double>(), plain_mean = mean.cast<double>();
  MatrixD plain_square = square.cast<double>();
  reference::adam_update(plain, plain_mean, plain_square, gradient.cast<double>(), rule, step);
  check_value(want, plain);
  check_value(want_mean, plain_mean);
  check_value(want_square, plain_square);
}

const UpdateRule kRules[] = {{.rate = 1e-3F, .momentum = 0.0F, .weight_decay = 0.0F},
                             {.rate = 1e-3F, .momentum = 0.9F, .weight_decay = 2e-4F},
                             {.rate = 0.1F, .momentum = 0.5F, .weight_decay = 0.1F}};

void check_gradient_limit(Device& device) {
  const MatrixF first = random_matrix(7, 17, 1), second = random_matrix(1, 3, 2);
  const Parameters parameters(device, {{.name = "first", .rows = 7, .columns = 17},
                                       {.name = "second", .rows = 1, .columns = 3}});
  const Matrix gradients = Matrix::like(parameters.all());
  Parameters both = parameters.in(gradients);
  both.upload("first", first);
  both.upload("second", second);
  MatrixF all(1, first.size() + second.size());
  all << first.reshaped<Eigen::RowMajor>().transpose(), second;
  const Bounded length = reference::square_root(total(times(exact(all), exact(all))));
  const auto half_length = static_cast<float>(0.5 * length.value(0));
  GradientLimit limit(parameters);
  limit.measure(gradients, half_length);
  check_within(limit.scale().to_host(),
               quotient(exact(MatrixF::Constant(1, 1, half_length)), length));
  limit.measure(gradients, 4.0F * half_length);
  CHECK(limit.scale().to_host()(0) == 1.0F);
  CHECK_THROWS_AS(limit.measure(Matrix(device, 1, 16), 1.0F), ShapeError);
}

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
    check_gradient_limit(device);
    Device gpu = as_gpu(device);  // whose work-items share the sum
    check_gradient_limit(gpu);

    const MatrixF first = random_matrix(7, 17, 1);
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

TEST_CASE("small: L1 pulls a weight towards zero by its rate, a bias not, zero nowhere") {
  on_every_device([](Device& device) {
    MatrixF start = random_matrix(7, 17, 1);
    start(2, 3) = 0.0F;
    const MatrixF gradient = random_matrix(7, 17, 2), mean = random_matrix(7, 17, 3);
    UpdateRule rule{.rate = 0.1F, .momentum = 0.6F, .weight_decay = 0.02F};
    rule.l1 = 0.05F;
    for (const OptimizerKind kind : {OptimizerKind::momentum, OptimizerKind::adam})
      for (const bool is_weight : {true, false}) {
        CAPTURE(is_weight);
        OneMatrix got(device, start, kind, is_weight);
        got.set_state(0, mean);
        got.set_gradient(gradient);
        got.update(rule);
        const UpdateRule taken = is_weight ? rule : rule.without_decay();
        Bounded want = exact(start), first = exact(mean), second = exact(MatrixF::Zero(7, 17));
        MatrixD plain = start.cast<double>(), plain_first = mean.cast<double>(),
                plain_second = MatrixD::Zero(7, 17);
        if (kind == OptimizerKind::momentum) {
          reference::bounded_momentum_update(want, first, -exact(gradient), taken);
          reference::momentum_update(plain, plain_first, -gradient.cast<double>(), taken);
        } else {
          reference::bounded_adam_update(want, first, second, exact(gradient), taken, 1);
          reference::adam_update(plain, plain_first, plain_second, gradient.cast<double>(), taken,
                                 1);
        }
        check_value(want, plain);
        check_within(got.values(), want);
      }
  });
}

TEST_CASE("small: fast weights forget, learn at their own rate and add to the parameters") {
  on_every_device([](Device& device) {
    Parameters parameters(
        device, {{.name = "W", .rows = 5, .columns = 19}, {.name = "A", .rows = 3, .columns = 3}});
    const Matrix gradients = Matrix::like(parameters.all());
    Matrix fast = Matrix::like(gradients), sum = Matrix::like(gradients);
    for (const auto& [name, rows, columns] : {std::tuple{"W", 5U, 19U}, std::tuple{"A", 3U, 3U}}) {
      parameters.upload(name, random_matrix(rows, columns, 1));
      parameters.in(fast).upload(name, random_matrix(rows, columns, 2));
      parameters.in(gradients).upload(name, random_matrix(rows, columns, 3));
    }
    fast_update(fast, sum, parameters, gradients, 0.75F,
                [](const ParameterShape& shape) { return shape.name == "A" ? 0.0F : 0.5F; });
    for (const std::string name : {"W", "A"}) {
      const Bounded before = exact(random_matrix(name == "W" ? 5 : 3, name == "W" ? 19 : 3, 2)),
                    gradient = exact(random_matrix(name == "W" ? 5 : 3, name == "W" ? 19 : 3, 3));
      const Bounded want = 0.75 * before - (name == "A" ? 0.0 : 0.5) * gradient;
      check_within(parameters.in(fast).to_host(name), want);
      check_within(parameters.in(sum).to_host(name), exact(parameters.to_host(name)) + want);
      CHECK(padding_is_zero(parameters.in(sum).matrix(name)));
    }
    CHECK_THROWS_AS(fast_update(fast, sum, parameters, Matrix(device, 1, 16), 0.5F,
                                [](const ParameterShape&) { return 0.5F; }),
                    ShapeError);
  });
}

TEST_CASE("small: a moving average goes the given share of the way") {
  on_every_device([](Device& device) {
    const MatrixF before = random_matrix(5, 19, 1), parameter = random_matrix(5, 19, 2);
    Matrix average = Matrix::from_host(device, before);
    average_update(average, Matrix::from_host(device, parameter), 0.3F);
    check_within(average.to_host(),
                 exact(before) + double{0.3F} * (exact(parameter) - exact(before)));
    CHECK(padding_is_zero(average));
  });
}

TEST_CASE("small: a moving average refuses shapes that differ") {
  on_every_device([](Device& device) {
    Matrix x(device, 3, 5);
    CHECK_THROWS_AS(average_update(x, Matrix(device, 5, 3), 0.5F), ShapeError);
  });
}

}  // namespace optimizer_test
