// CD-PercLoss against double precision with its own draws; which rule the settings specify.
#include "learning/mrbm_rule.hpp"

#include "device/every_device.hpp"
#include "learning/joint_likelihood.hpp"
#include "learning/mrbm_rules_scene.hpp"
#include "learning/multi_prediction.hpp"
#include "learning/perceptron_loss.hpp"

namespace mrbm_rules_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE(
    "small: CD-PercLoss learns from rows whose chain ends lower than the data, and no others") {
  for (const auto& [scene, sampled] :
       {std::pair{&two(), false}, {&three(), false}, {&two(), true}, {&three(), true}}) {
    const MrbmSettings settings{.gibbs_steps = 2, .sample_visible = sampled};
    GradientSums sums(scene->codes.size());
    int lower = 0, higher = 0;
    for (std::size_t m = 0; m < scene->codes.size(); ++m) {
      ReferenceChain chain(*scene, settings);
      if (sampled) chain.draw_data(kKey);
      RandomKey key = kKey;
      key.stream = static_cast<std::uint16_t>(kKey.stream + m);
      chain.start(key);
      chain.run({m}, key);
      const Eigen::VectorXd gap = chain.energy(m, chain.end) - chain.energy(m, chain.data);
      // A chain that ends where it began has no gap; any other is wider than rounding.
      REQUIRE((gap.array() == 0.0 || gap.array().abs() > 1e-4).all());
      const auto is_lower = (gap.array() < 0.0).cast<double>();
      lower += static_cast<int>(is_lower.sum());
      higher += static_cast<int>(gap.size() - is_lower.sum());
      chain.add_to(sums, is_lower.matrix());
    }
    const reference::BoundedMrbm want = sums.mean(scene->rows());
    REQUIRE(lower > 0);
    REQUIRE(higher > 0);
    on_every_device([&, scene = scene](Device& device) {
      Mrbm mrbm(device, scene->start);
      PerceptronLoss rule(mrbm, scene->rows(), settings, OptimizerKind::none);
      run(device, *scene, rule, 2);
      const MrbmParameters unlike = rule.gradients();  // the second step has other draws
      PerceptronLoss again(mrbm, scene->rows(), settings, OptimizerKind::none);
      run(device, *scene, again, 1);
      check_within(again.gradients(), want);
      CHECK(unlike.W[0] != again.gradients().W[0]);
    });
  }
}

TEST_CASE("the settings specify which rule and which optimizer learn an MRBM") {
  on_every_device([](Device& device) {
    Mrbm mrbm(device, two().start);
    const auto rule = [&](const MrbmSettings& settings) {
      return make_mrbm_rule(mrbm, 7, settings);
    };
    CHECK(dynamic_cast<MultiPrediction*>(rule({}).get()));
    CHECK(dynamic_cast<JointLikelihood*>(rule({.joint_likelihood = true}).get()));
    CHECK(dynamic_cast<PerceptronLoss*>(rule({.perceptron_loss = true}).get()));
    CHECK(dynamic_cast<JointLikelihood*>(
        rule({.joint_likelihood = true, .perceptron_loss = true}).get()));

    // One step of plain gradient descent: the gradient times the rate.
    for (const bool joint : {false, true}) {
      const MrbmSettings settings{.rate = 0.25,
                                  .joint_likelihood = joint,
                                  .perceptron_loss = !joint,
                                  .adam = false,
                                  .momentum = 0.5};
      Mrbm moved(device, two().start), still(device, two().start);
      run(device, two(), *make_mrbm_rule(moved, 7, settings));
      std::unique_ptr<MrbmChains> gradient;
      if (joint)
        gradient = std::make_unique<JointLikelihood>(still, 7, settings, OptimizerKind::none);
      else
        gradient = std::make_unique<PerceptronLoss>(still, 7, settings, OptimizerKind::none);
      run(device, two(), *gradient);
      const MatrixF step = moved.to_host().W[0] - two().start.W[0];
      CHECK((step + 0.25F * gradient->gradients().W[0]).cwiseAbs().maxCoeff() < 1e-6F);
      CHECK(moved.W_transposed[0].to_host() == moved.to_host().W[0].transpose());
    }
  });
}

}  // namespace mrbm_rules_test
