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

double between_deg(const Matrix3d& from, const Matrix3d& to) {
  return Eigen::AngleAxisd(from.transpose() * to).angle() * 180 / M_PI;
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
  for (const double within : {-4.9, 0.0, 30.0, 94.9})
    CHECK(limits.clamped(at(within), half) == at(within));
  for (const double beyond : {10.0, 40.0}) {
    CHECK(limits.clamped(at(95 + beyond), half).isApprox(at(95), 1e-3));
    CHECK(limits.clamped(at(-5 - beyond), half).isApprox(at(-5), 1e-3));
  }
  // Across the hinge nothing but the margin of 5 degrees about each of two axes.
  const Matrix3d across = half * turned_deg(30, Vector3d(1, -1, 0)),
                 clamped = limits.clamped(across, half);
  CHECK(between_deg(half, clamped) < 7.2);
  CHECK(limits.clamped(clamped, half).isApprox(clamped));
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
  const Matrix3d rest = Matrix3d::Identity(), near = turned_deg(14, Vector3d::UnitX());
  CHECK(between_deg(limits.clamped(near, rest), near) < 0.2);
  CHECK(between_deg(limits.clamped(turned_deg(90, Vector3d::UnitX()), rest), rest) < 20);
}
