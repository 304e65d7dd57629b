#include "learning/random_start.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "learning/small_network.hpp"
#include "reference/unrolled_gradient.hpp"

namespace random_start_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kTrack = 7, kPose = 9;
const std::vector<Modality> kModalities{{"track", kTrack, VisibleKind::gaussian},
                                        {"pose", kPose, VisibleKind::gaussian}};

LearningSettings settings() {
  LearningSettings config;
  config.seed = 77;
  config.hidden = 6;
  config.mrbm_hidden = 5;
  config.layers = 3;
  config.order = 2;
  config.look_ahead = 4;
  config.fine_tuning.mean_field_steps = 3;
  config.mrbm.mean_field_steps = 8;
  return config;
}

/// Weights of one layer as the start is meant to be: drawn, at sizes that keep signals alive.
reference::Crbm expected_layer(const LearningSettings& config, std::size_t visible, bool lowest,
                               bool pose, std::uint32_t number) {
  const CrbmParameters drawn = CrbmParameters::random(
      {visible, config.hidden, config.order, lowest ? VisibleKind::gaussian : VisibleKind::binary},
      1.0, {config.seed, number, 195, 0});
  const double width = static_cast<double>(visible),
               history = 1.0 / std::sqrt(static_cast<double>(config.order) * width),
               hidden = static_cast<double>(config.hidden);
  reference::Crbm layer;
  const double up = lowest && pose ? 1.5 / std::sqrt(hidden) : 0.8 / std::sqrt(width);
  layer.weights = up * drawn.W.cast<double>();
  if (!lowest) layer.weights.diagonal().array() += 4.0;
  layer.hidden_history = 0.6 * history * drawn.B.cast<double>();
  layer.visible_history = 0.09 * history * drawn.A.cast<double>();
  return layer;
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("the start of fine-tuning: every matrix drawn on its own, at the size that was meant") {
  const LearningSettings config = settings();
  on_every_device([&](Device& device) {
    const Mcdbn start = random_start(device, kModalities, config);
    CHECK(start.look_ahead == 4);
    CHECK(start.mean_field_steps == 3);
    const reference::UnrolledModel own = in_double(on_host(start)),
                                   middle = reference::centered(own);
    // The MRBM draws first, then the layers of 2D from below, then those of 3D.
    std::uint32_t number = 2;  // one for each modality of the MRBM
    for (const std::size_t m : {0, 1}) {
      REQUIRE(own.stacks[m].size() == 3);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t visible = i > 0 ? config.hidden : m == 0 ? kTrack : kPose;
        const reference::Crbm want = expected_layer(config, visible, i == 0, m == 1, number++);
        const reference::Crbm& got = middle.stacks[m][i];
        CAPTURE(m);
        CAPTURE(i);
        CHECK(start.cdbns[m].layers[i].shape().kind ==
              (i == 0 ? VisibleKind::gaussian : VisibleKind::binary));
        CHECK(largest(got.weights - want.weights) < 1e-6);
        CHECK(largest(got.visible_history - want.visible_history) < 1e-6);
        CHECK(largest(got.hidden_history - want.hidden_history) < 1e-6);
        // No unit is pushed anywhere.
        CHECK(largest(got.visible_bias) < 1e-5);
        CHECK(largest(got.hidden_bias) < 1e-5);
      }
    }
    const MrbmParameters drawn =
        MrbmParameters::random(two_modalities(config.hidden, config.hidden, config.mrbm_hidden),
                               1.0, {config.seed, 0, 195, 0});
    const double shared = 1.0 / std::sqrt(static_cast<double>(config.hidden));
    for (const std::size_t m : {0, 1}) {
      MatrixD want = shared * drawn.W[m].cast<double>();
      want.diagonal().array() += m == 0 ? 4.0 : 2.0;
      want.rowwise() -= RowVectorD(want.colwise().mean());
      CHECK(largest(middle.mrbm.weights[m] - want) < 1e-6);
      CHECK(largest(middle.mrbm.visible_bias[m]) < 1e-5);
    }
    CHECK(largest(middle.mrbm.hidden_bias) < 1e-5);
  });
}

TEST_CASE("no two matrices of the start are the same numbers, of three modalities either") {
  LearningSettings config = settings();
  config.hidden = config.mrbm_hidden = kPose;  // all alike in size
  std::vector<Modality> modalities{{"one", kPose, VisibleKind::gaussian},
                                   {"two", kPose, VisibleKind::gaussian},
                                   {"three", kPose, VisibleKind::gaussian}};
  on_every_device([&](Device& device) {
    const Mcdbn start = random_start(device, modalities, config);
    std::vector<MatrixD> drawn;
    const auto take = [&](const Matrix& W) {
      MatrixD numbers = W.to_host().topRows(kPose).cast<double>();
      numbers.diagonal().setZero();  // which passes on
      drawn.push_back(numbers / numbers.norm());
    };
    for (const Matrix& W : start.mrbm.W) take(W);
    for (const Cdbn& cdbn : start.cdbns)
      for (const Crbm& layer : cdbn.layers)
        for (const Matrix* matrix : {&layer.W, &layer.A, &layer.B}) take(*matrix);
    REQUIRE(drawn.size() == 3 + 3 * 3 * 3);
    for (std::size_t i = 0; i < drawn.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        CAPTURE(i);
        CAPTURE(j);
        // Of 72 numbers drawn apart the correlation is 0.12 times a normal one.
        CHECK(std::abs((drawn[i].array() * drawn[j].array()).sum()) < 0.7);
      }
  });
}

TEST_CASE("another seed, another start") {
  const LearningSettings config = settings();
  on_every_device([&](Device& device) {
    const Mcdbn first = random_start(device, kModalities, config);
    LearningSettings other = config;
    other.seed = 78;
    const Mcdbn second = random_start(device, kModalities, other);
    CHECK(first.cdbns[1].layers[1].W.to_host() != second.cdbns[1].layers[1].W.to_host());
    CHECK(first.mrbm.W[0].to_host() != second.mrbm.W[0].to_host());
    CHECK(first.cdbns[0].layers[0].W.to_host() != second.cdbns[0].layers[0].W.to_host());
  });
}

}  // namespace random_start_test
