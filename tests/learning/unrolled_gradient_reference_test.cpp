#include <doctest/doctest.h>

#include "learning/small_network.hpp"
#include "reference/fine_tuning_reference.hpp"
#include "reference/finite_difference.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using namespace mcdbn::reference;

namespace {

constexpr int kFrames = 8, kFirst = 4, kSteps = 3;

DropOut some_drop_out(const UnrolledModel& model, int present) {
  FineTuningSettings settings;
  settings.dropout = 0.3;
  return drawn_drop_out(model, present, settings, 5, 0, 2);
}

}  // namespace

// The reference of fine-tuning is itself compared with the forward reference.
TEST_CASE("back-propagation in double gives the finite differences of the forward reference") {
  const UnrolledModel model =
      in_double(random_network({3, 5}, {{{{4, 2, 2, 1}, {3, 1}}, {{2, 1}, {6, 3, 2, 3}}}}, 4, 100));
  for (const int present : {0, 1}) {
    const MatrixD values = random_matrix(kFrames, present == 0 ? 3 : 5, 7).cast<double>(),
                  target = random_matrix(kFrames, present == 0 ? 5 : 3, 8).cast<double>();
    const WindowLayout layout{1, kFrames, kFirst, kFirst + 1};
    const DropOut drop_out = some_drop_out(model, present);
    const auto loss = [&](const Eigen::VectorXd& flat) {
      const UnrolledModel moved = uncentered(model.with_parameters(flat));
      // Starts do not belong to the parameters: they stay those of `model`.
      UnrolledModel same_start = moved;
      same_start.start = model.start;
      return mean_squared(layout,
                          joint_prediction(same_start, present, values, kFirst, kSteps, drop_out),
                          target, 0.7)
          .loss;
    };
    const UnrolledModel middle = centered(model);
    const UnrolledGradient pass(middle, present, values, kFirst, kSteps, drop_out);
    const MatrixD forward = joint_prediction(model, present, values, kFirst, kSteps, drop_out);
    CHECK((pass.prediction() - forward).bottomRows(kFrames - kFirst).cwiseAbs().maxCoeff() < 1e-14);
    UnrolledModel sum = middle.with_parameters(Eigen::VectorXd::Zero(middle.flattened().size()));
    pass.add_to(sum, mean_squared(layout, pass.prediction(), target, 0.7).error);
    const Eigen::VectorXd want = finite_difference(loss, middle.flattened());
    CHECK(want.cwiseAbs().maxCoeff() > 0.01);
    CHECK((sum.flattened() - want).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((uncentered(middle).flattened() - model.flattened()).cwiseAbs().maxCoeff() < 1e-14);
  }
}
