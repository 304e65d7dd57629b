#include "learning/multi_prediction.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/finite_difference.hpp"

namespace multi_prediction_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct MrbmCase {
  std::size_t track, pose, hidden, batch;
  int steps;
};
const std::vector<MrbmCase> kSmallCases = {{1, 1, 1, 1, 1}, {4, 3, 7, 3, 5}, {17, 13, 9, 13, 3}};
const std::vector<MrbmCase> kModelCases = {{300, 300, 150, 100, 5}};

class Scene {
 public:
  explicit Scene(const MrbmCase& shape) : shape_(shape) {
    const float scale = 1.0F / std::sqrt(static_cast<float>(shape.hidden));
    parameters = mrbm_of({random_matrix(shape.track, shape.hidden, 1, scale),
                          random_matrix(shape.pose, shape.hidden, 2, scale)},
                         {random_matrix(1, shape.track, 3), random_matrix(1, shape.pose, 4)},
                         random_matrix(1, shape.hidden, 5));
    for (std::size_t m = 0; m < 2; ++m)
      codes[m] = (random_matrix(shape.batch, m == 0 ? shape.track : shape.pose,
                                6 + static_cast<unsigned>(m))
                      .array() +
                  1.0F) /
                 2.0F;
  }

  reference::Mrbm model() const { return in_double(parameters); }
  reference::BoundedMultiPrediction bounded() const {
    return reference::bounded_multi_prediction(reference::BoundedMrbm::exact(model()), batch(),
                                               shape_.steps);
  }
  std::vector<MatrixD> batch() const { return {codes[0].cast<double>(), codes[1].cast<double>()}; }
  int steps() const { return shape_.steps; }

  struct Trained {
    MrbmParameters gradients, parameters;
    std::vector<float> losses;
  };
  Trained train(Device& device, const UpdateRule& rule, int steps = 1) const {
    const Matrix track = Matrix::from_host(device, codes[0]);
    const Matrix pose = Matrix::from_host(device, codes[1]);
    std::vector<std::int32_t> backwards(shape_.batch);
    for (std::size_t r = 0; r < shape_.batch; ++r)
      backwards[r] = static_cast<std::int32_t>(shape_.batch - 1 - r);
    const IndexBuffer index(device, backwards);
    const auto every_row = [&](const Matrix& matrix) {
      return Rows::indexed(matrix, index, 0, shape_.batch);
    };
    Mrbm mrbm(device, parameters);
    const MrbmSettings settings{.mean_field_steps = static_cast<std::size_t>(shape_.steps)};
    Mrbm still(device, parameters);
    MultiPrediction gradient(still, shape_.batch, settings, OptimizerKind::none);
    LossAccumulator losses(device, 2, shape_.batch);
    gradient.step({every_row(track), every_row(pose)}, rule, losses);
    losses.read_and_reset();
    MultiPrediction trainer(mrbm, shape_.batch, settings);
    for (int i = 0; i < steps; ++i) trainer.step({every_row(track), every_row(pose)}, rule, losses);
    return {gradient.gradients(), mrbm.to_host(), losses.read_and_reset()};
  }

  MrbmParameters parameters;
  std::array<MatrixF, 2> codes;

 private:
  MrbmCase shape_;
};

void check_gradients(const std::vector<MrbmCase>& cases) {
  for (const MrbmCase& shape : cases) {
    const Scene scene(shape);
    INFO(shape.track, " + ", shape.pose, " / ", shape.hidden, ", batch ", shape.batch, ", steps ",
         shape.steps);
    const auto want = scene.bounded();
    on_every_device([&](Device& device) {
      const auto got = scene.train(device, UpdateRule::adam());
      check_within(got.gradients, want.gradient);
      // Mean cross-entropies of a unit.
      REQUIRE(got.losses.size() == 2);
      check_within("loss of the track", got.losses[0], want.losses[0]);
      check_within("loss of the pose", got.losses[1], want.losses[1]);
    });
  }
}

}  // namespace

TEST_CASE(
    "small: multi-prediction gradients and losses are the double reference's within rounding") {
  check_gradients(kSmallCases);
}

TEST_CASE("multi-prediction gradients and losses at the model's sizes, within rounding") {
  check_gradients(kModelCases);
}

TEST_CASE("the bounded gradients and losses are the plain reference's") {
  for (const MrbmCase& shape : kSmallCases) {
    const Scene scene(shape);
    const auto [bounded, losses] = scene.bounded();
    const auto [loss, plain] =
        reference::multi_prediction(scene.model(), scene.batch(), scene.steps());
    for (std::size_t m = 0; m < 2; ++m) {
      CHECK((bounded.weights[m].value - plain.weights[m]).cwiseAbs().maxCoeff() < 1e-12);
      CHECK((bounded.visible_bias[m].value - plain.visible_bias[m]).cwiseAbs().maxCoeff() < 1e-12);
    }
    CHECK((bounded.hidden_bias.value - plain.hidden_bias).cwiseAbs().maxCoeff() < 1e-12);
    const double sum = losses[0].value(0) * static_cast<double>(shape.track) +
                       losses[1].value(0) * static_cast<double>(shape.pose);
    CHECK(std::abs(sum - loss) < 1e-12 * loss);
  }
}

TEST_CASE("small: multi-prediction gradients on the device agree with finite differences") {
  const MrbmCase shape{5, 4, 3, 6, 4};
  const Scene scene(shape);
  const reference::Mrbm model = scene.model();
  const Eigen::VectorXd numeric = reference::finite_difference(
      [&](const Eigen::VectorXd& x) {
        return reference::multi_prediction(model.with_parameters(x), scene.batch(), scene.steps())
            .loss;
      },
      model.flattened());
  on_every_device([&](Device& device) {
    const auto got = scene.train(device, UpdateRule::adam()).gradients;
    CHECK(numeric.norm() > 0.1);
    CHECK((in_double(got).flattened() - numeric).cwiseAbs().maxCoeff() < 1e-6);
  });
}

TEST_CASE("Adam on the multi-prediction gradients lowers the loss, the same way each time") {
  const Scene scene(kSmallCases[2]);
  on_every_device([&](Device& device) {
    UpdateRule rule = UpdateRule::adam();
    rule.rate = 0.01F;
    const auto first = scene.train(device, rule, 1), many = scene.train(device, rule, 200);
    const auto last = scene.train(device, rule, 201);
    const float before = first.losses[0] + first.losses[1];
    const float after = last.losses[0] + last.losses[1] - many.losses[0] - many.losses[1];
    CHECK(after < 0.9F * before);
    const auto again = scene.train(device, rule, 200);
    CHECK((again.parameters.W[0].array() == many.parameters.W[0].array()).all());
    CHECK((again.parameters.W[1].array() == many.parameters.W[1].array()).all());
  });
}

TEST_CASE("small: multi-prediction wants mini-batches of the size that it was made for") {
  on_every_device([&](Device& device) {
    const Scene scene(kSmallCases[1]);
    Mrbm mrbm(device, scene.parameters);
    CHECK_THROWS_AS(MultiPrediction(mrbm, 3, {.mean_field_steps = 0}), ConfigError);
    MultiPrediction trainer(mrbm, 4, {.mean_field_steps = 2});
    LossAccumulator losses(device, 2, 4);
    const Matrix track = Matrix::from_host(device, scene.codes[0]);
    const Matrix pose = Matrix::from_host(device, scene.codes[1]);
    CHECK_THROWS_AS(trainer.step({track, pose}, UpdateRule::adam(), losses), ShapeError);
    CHECK_THROWS_AS(trainer.step({track, Rows(pose, 0, 2)}, UpdateRule::adam(), losses),
                    ShapeError);
  });
}

}  // namespace multi_prediction_test
