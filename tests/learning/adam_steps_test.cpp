// Adam's steps in contrastive divergence where momentum sets in after some epochs.

#include <doctest/doctest.h>

#include <numeric>

#include "device/every_device.hpp"
#include "learning/contrastive_divergence.hpp"

namespace adam_steps_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("small: with a constant gradient Adam's steps are its rate, whenever momentum sets in") {
  constexpr std::size_t kBatch = 4, kVisible = 3;
  // So small that parameters stay near 0 and the gradient of the visible biases, the frames less
  // their reconstruction, stays at 1 within a thousandth.
  CdSettings settings{.gibbs_steps = 1, .rate = 1e-5, .momentum = 0.9, .momentum_from_epoch = 3};
  settings.adam = true;
  const CrbmShape shape{kVisible, 2, 0, VisibleKind::gaussian};
  std::vector<std::int32_t> rows(kBatch);
  std::iota(rows.begin(), rows.end(), 0);
  on_every_device([&](Device& device) {
    const Matrix frames = Matrix::from_host(device, MatrixF::Ones(kBatch, kVisible));
    const IndexBuffer index(device, rows);
    const std::array<Rows, 1> batch{Rows::indexed(frames, index, 0, kBatch)};
    LossAccumulator losses(device, 1, kBatch);
    for (const bool fused : {true, false}) {
      CAPTURE(fused);
      Crbm crbm(device, CrbmParameters::zeros(shape));
      ContrastiveDivergence rule(
          crbm, kBatch, fused ? choose_chain_tile(device, shape, kBatch) : std::nullopt, settings);
      MatrixF before = crbm.a.to_host();
      LearningStep step;
      for (step.epoch = 1; step.epoch <= 8; ++step.epoch) {
        CAPTURE(step.epoch);
        rule.learn(batch, step, losses);
        ++step.random.step;
        const MatrixF now = crbm.a.to_host(), ratio = (now - before) / 1e-5F;
        CHECK((ratio.array() - 1.0F).abs().maxCoeff() < 1e-3F);
        before = now;
      }
    }
  });
}

}  // namespace adam_steps_test
