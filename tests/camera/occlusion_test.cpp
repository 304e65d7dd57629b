#include "camera/occlusion.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace occlusion_test {

using namespace mcdbn;
using enum JointRole;

namespace {

constexpr double kHeight = 100;

/// A body that faces +z, 100 units tall; roles that it lacks are NaN.
RolePositions standing() {
  RolePositions body;
  body.height = kHeight;
  body.positions = MatrixD::Constant(1, 3 * static_cast<Eigen::Index>(joint_roles().size()),
                                     std::numeric_limits<double>::quiet_NaN());
  const auto put = [&](JointRole role, double x, double y, double z) {
    body.positions.block<1, 3>(0, 3 * static_cast<Eigen::Index>(role)) << x, y, z;
  };
  put(pelvis, 0, 53, 0);
  put(neck, 0, 82, 0);
  put(head, 0, 91, 0);
  for (const double side : {1.0, -1.0}) {
    const bool left = side > 0;
    put(left ? left_hip : right_hip, 6 * side, 52, 0);
    put(left ? left_knee : right_knee, 6 * side, 28, 0);
    put(left ? left_ankle : right_ankle, 6 * side, 4, 0);
    put(left ? left_shoulder : right_shoulder, 12 * side, 82, 0);
    put(left ? left_elbow : right_elbow, 13 * side, 63, 0);
    put(left ? left_wrist : right_wrist, 13 * side, 48, 0);
  }
  return body;
}

/// At the body's middle height, so far away that all lines of sight are nearly parallel.
Camera camera_at_azimuth(double azimuth_deg) {
  Camera camera;
  camera.camera_from_world = camera_rotation(azimuth_deg, 0);
  camera.translation =
      Eigen::Vector3d(0, 0, 1000) - camera.camera_from_world * Eigen::Vector3d(0, 50, 0);
  return camera;
}

bool hides(const RolePositions& body, JointRole role, double azimuth_deg,
           Eigen::Vector3d offset = {0, 0, 0}) {
  Keypoint point;
  point.role = role;
  const MatrixD place = (body.at(0, role) + offset).transpose();
  return hidden_places(body, {point}, place, camera_at_azimuth(azimuth_deg))(0, 0);
}

}  // namespace

TEST_CASE("from the front a standing body hides nothing of itself, from the side its far limbs") {
  const RolePositions body = standing();
  for (const JointRole role :
       {left_hip, right_hip, left_knee, right_knee, left_ankle, right_ankle, left_shoulder,
        right_shoulder, left_elbow, right_elbow, left_wrist, right_wrist})
    CHECK_FALSE(hides(body, role, 0));
  // From its left the left leg and arm are before the right ones, and before the trunk.
  for (const JointRole role : {right_knee, right_elbow, right_wrist, right_ankle})
    CHECK(hides(body, role, 90));
  for (const JointRole role : {left_knee, left_elbow, left_wrist, left_ankle}) {
    CHECK_FALSE(hides(body, role, 90));
    CHECK(hides(body, role, -90));
  }
}

TEST_CASE("what is behind the trunk is hidden, what is before it is not") {
  RolePositions body = standing();
  for (const double z : {15.0, -15.0}) {
    body.positions.block<1, 3>(0, 3 * static_cast<Eigen::Index>(left_wrist)) << 2, 65, z;
    CHECK(hides(body, left_wrist, 0) == (z < 0));
    CHECK(hides(body, left_wrist, 180) == (z > 0));
  }
  // What lies on its surface or in it is no further away than its own thickness.
  CHECK_FALSE(hides(body, left_hip, 180));
}

TEST_CASE("a face is hidden by the head that carries it when the camera is behind") {
  const RolePositions body = standing();
  const Eigen::Vector3d nose(0, 0, 7.5);
  CHECK_FALSE(hides(body, head, 0, nose));
  CHECK_FALSE(hides(body, head, 90, nose));
  CHECK(hides(body, head, 180, nose));
  CHECK_FALSE(hides(body, head, 180));  // the joint itself is in the head
}

TEST_CASE("a limb that is not there hides nothing") {
  RolePositions body = standing();
  CHECK(hides(body, right_knee, 90));
  body.positions.block<1, 3>(0, 3 * static_cast<Eigen::Index>(left_knee))
      .setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK_FALSE(hides(body, right_knee, 90));
}

}  // namespace occlusion_test
