#include "mcdbn/learning/layer_health.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace mcdbn {
namespace {

constexpr std::size_t kOrder = 2;

CrbmParameters zero_crbm(VisibleKind kind) {
  return CrbmParameters::zeros({3, 4, kOrder, kind});
}

std::vector<MatrixF> windows_of(float value) {
  return {5, MatrixF::Constant(kOrder + kFreeRunFrames, 3, value)};
}

}  // namespace

TEST_CASE("crbm_health: norms, activity and saturation by hand") {
  CrbmParameters parameters = zero_crbm(VisibleKind::gaussian);
  parameters.W(1, 2) = 3;
  parameters.W(0, 0) = 4;
  parameters.A(5, 1) = 2;
  parameters.B(0, 3) = -7;
  parameters.b.row(0) << 0, 0, 0, 12;
  const LayerHealth health = crbm_health(parameters, windows_of(0));
  CHECK(health.weight_norm == doctest::Approx(5));
  CHECK(health.weight_norm_A.value() == doctest::Approx(2));
  CHECK(health.weight_norm_B.value() == doctest::Approx(7));
  CHECK(health.hidden_activity == doctest::Approx((3 * 0.5 + 1) / 4).epsilon(1e-4));
  CHECK(health.saturation == doctest::Approx(0.25));
}

TEST_CASE("crbm_health: the history drives the hidden units and the free run") {
  // v = â: the visible unit repeats what it was two frames before.
  CrbmParameters parameters = zero_crbm(VisibleKind::gaussian);
  for (int unit = 0; unit < 3; ++unit) parameters.A(unit, unit) = 1;
  std::vector<MatrixF> alternating = windows_of(0);
  for (MatrixF& window : alternating)
    for (Eigen::Index t = 0; t < window.rows(); ++t) window.row(t).setConstant(t % 2 ? 1.F : -1.F);
  CHECK(crbm_health(parameters, alternating).free_run_error.value() == doctest::Approx(0));
  // One that repeats the last frame is off by 2 at every other frame.
  parameters.A.setZero();
  for (int unit = 0; unit < 3; ++unit) parameters.A(3 + unit, unit) = 1;
  CHECK(crbm_health(parameters, alternating).free_run_error.value() == doctest::Approx(2));
  // Its own output is what it goes on from: after one step of half, the rest halves again.
  parameters.A *= 0.5F;
  double expected = 0, value = 1;
  for (std::size_t t = 0; t < kFreeRunFrames; ++t) {
    value *= 0.5;
    expected += (value - 1) * (value - 1) / kFreeRunFrames;
  }
  CHECK(crbm_health(parameters, windows_of(1)).free_run_error.value() == doctest::Approx(expected));
  // The oldest frame comes first in B.
  parameters.B.row(0).setConstant(100);
  std::vector<MatrixF> first_frame = windows_of(0);
  for (MatrixF& window : first_frame) window(0, 0) = 1;
  CHECK(crbm_health(parameters, first_frame).hidden_activity == doctest::Approx(1));
}

TEST_CASE("crbm_health: windows of order + 1 frames are enough for the hidden units") {
  CrbmParameters parameters = zero_crbm(VisibleKind::gaussian);
  parameters.b.row(0) << 0, 0, 0, 12;
  const LayerHealth health =
      crbm_health(parameters, {MatrixF::Zero(kOrder + 1, 3), MatrixF::Zero(kOrder + 1, 3)});
  CHECK(health.hidden_activity == doctest::Approx((3 * 0.5 + 1) / 4).epsilon(1e-4));
  CHECK(health.saturation == doctest::Approx(0.25));
  CHECK(!health.free_run_error);
}

TEST_CASE("crbm_health: the free run's error is in the data's units, whatever the deviation") {
  CrbmParameters parameters = zero_crbm(VisibleKind::gaussian);
  parameters.visible_deviation.row(0) << 0.5F, 2, 1;
  // Units that are 0 answer 0 in the data's units, too.
  CHECK(crbm_health(parameters, windows_of(3)).free_run_error.value() == doctest::Approx(9));
  // Units that are 1 answer the deviation.
  parameters.a.setOnes();
  CHECK(crbm_health(parameters, windows_of(3)).free_run_error.value() ==
        doctest::Approx((2.5 * 2.5 + 1 * 1 + 2 * 2) / 3));
}

TEST_CASE("crbm_health: binary units, and no window at all") {
  CrbmParameters parameters = zero_crbm(VisibleKind::binary);
  CHECK(crbm_health(parameters, windows_of(0.5F)).free_run_error.value() == doctest::Approx(0));
  CHECK(crbm_health(parameters, windows_of(1)).free_run_error.value() == doctest::Approx(0.25));
  const LayerHealth health = crbm_health(parameters, {});
  CHECK(!health.free_run_error);
  CHECK(health.weight_norm == 0);
}

TEST_CASE("mrbm_health sees both modalities") {
  MrbmParameters parameters = MrbmParameters::zeros({{{"track", 2}, {"pose", 1}}, 1});
  parameters.W = {MatrixF::Constant(2, 1, 1), MatrixF::Constant(1, 1, -2)};
  const MatrixF track = MatrixF::Ones(3, 2), pose = MatrixF::Ones(3, 1);
  CHECK(mrbm_health(parameters, {track, pose}).hidden_activity == doctest::Approx(0.5));
  CHECK(mrbm_health(parameters, {track, 0 * pose}).hidden_activity ==
        doctest::Approx(1 / (1 + std::exp(-2.0))));
  CHECK(mrbm_health(parameters, {track, pose}).weight_norm == doctest::Approx(std::sqrt(6.0)));
  CHECK(!mrbm_health(parameters, {track, pose}).free_run_error);
}

}  // namespace mcdbn
