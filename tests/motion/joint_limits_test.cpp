#include "motion/joint_limits.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

using namespace mcdbn;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Matrix3d turned_deg(double deg, const Vector3d& axis) {
  return Eigen::AngleAxisd(deg * M_PI / 180, axis.normalized()).toRotationMatrix();
}

}  // namespace

TEST_CASE("joint limits: a hinge bends as far as it was seen to, and about its own axis alone") {
  const Vector3d hinge(1, 1, 0);
  const Matrix3d base = turned_deg(50, Vector3d::UnitZ());
  std::vector<Matrix3d> seen;
  for (int deg = 0; deg <= 90; ++deg) seen.push_back(base * turned_deg(deg, hinge));
  const JointLimits limits = JointLimits::of(seen);
  const auto at = [&](double deg) { return (base * turned_deg(deg, hinge)).eval(); };
  const Matrix3d half = at(45);
  for (const double within : {-4.9, 0.0, 30.0, 94.9}) {
    CHECK(limits.beyond_deg(at(within)) < 1e-9);
    CHECK(limits.clamped(at(within), half) == at(within));
  }
  for (const double beyond : {10.0, 40.0}) {
    CHECK(limits.beyond_deg(at(95 + beyond)) == doctest::Approx(beyond).epsilon(0.01));
    CHECK(limits.clamped(at(95 + beyond), half).isApprox(at(95), 1e-3));
    CHECK(limits.clamped(at(-5 - beyond), half).isApprox(at(-5), 1e-3));
  }
  // Across the hinge nothing but the margin of 5 degrees.
  const Matrix3d across = half * turned_deg(30, Vector3d(1, -1, 0));
  CHECK(limits.beyond_deg(across) > 20);
  CHECK(limits.beyond_deg(limits.clamped(across, half)) < 1e-6);
  // What the clip itself shows stays, and is no leave for more.
  const Matrix3d far = at(120);
  CHECK(limits.clamped(far, far).isApprox(far));
  CHECK(limits.clamped(at(140), far).isApprox(far, 1e-3));
}

TEST_CASE("joint limits: half a percent at either end counts for nothing") {
  std::vector<Matrix3d> seen;
  for (int i = 0; i < 1000; ++i) seen.push_back(turned_deg(i % 21 - 10, Vector3d::UnitX()));
  seen[0] = turned_deg(90, Vector3d::UnitX());
  const JointLimits limits = JointLimits::of(seen);
  CHECK(limits.beyond_deg(turned_deg(14, Vector3d::UnitX())) < 0.2);
  CHECK(limits.beyond_deg(turned_deg(90, Vector3d::UnitX())) > 70);
}
