#include "camera/detector_track.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "camera/keypoint_places.hpp"
#include "camera/projected_keypoints.hpp"
#include "camera/role_body.hpp"
#include "motion/body_size.hpp"

namespace detector_track_test {

using namespace mcdbn;
using enum JointRole;

namespace {

Keypoint keypoint(const char* name, JointRole role, Eigen::Vector3d offset = {0, 0, 0}) {
  Keypoint made;
  made.name = name;
  made.role = role;
  made.offset = offset;
  return made;
}

Keypoint mid_hip() {
  Keypoint made = keypoint("MidHip", pelvis);
  made.halfway = {left_hip, right_hip};
  return made;
}

const std::vector<Keypoint> kSet = {keypoint("Nose", head, {0.01, 0.02, 0.1}), mid_hip(),
                                    keypoint("LKnee", left_knee), keypoint("RKnee", right_knee),
                                    keypoint("LToe", left_toe)};

Eigen::Vector3d place(const MatrixD& places, int frame, int column) {
  return places.row(frame).segment<3>(3 * column).transpose();
}

/// The same motion by a skeleton whose joints' axes are all turned.
Motion with_other_axes(const Motion& motion, const Eigen::Matrix3d& turn) {
  Motion other = motion;
  for (Joint& joint : other.skeleton.joints)
    if (joint.parent >= 0) joint.offset = turn.transpose() * joint.offset;
  for (Eigen::Index t = 0; t < motion.frames(); ++t)
    for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
      const Joint& joint = motion.skeleton.joints[static_cast<std::size_t>(j)];
      const int first = motion.skeleton.first_channel(j);
      const Eigen::Matrix3d local = local_rotation(joint, motion.channels.row(t).data() + first);
      set_local_rotation(joint, (joint.parent < 0 ? local : turn.transpose() * local) * turn,
                         nullptr, other.channels.row(t).data() + first);
    }
  return other;
}

bool same(const MatrixD& a, const MatrixD& b) {
  return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

}  // namespace

TEST_CASE("a keypoint lies off its joint as a standing body has it, and turns with the joint") {
  Motion motion = test::standing_still(test::role_body(), 2);
  const SkeletonRoles roles = test::roles_of_role_body();
  motion.channels(1, motion.skeleton.first_channel(2) + 2) = 90;  // the head turns to its left
  const MatrixD places = keypoint_places(motion, roles, kSet);
  const double height = body_height(motion.skeleton);
  const Eigen::Vector3d centre(0, 152, 0);
  CHECK((place(places, 0, 0) - centre).isApprox(height * Eigen::Vector3d(0.01, 0.02, 0.1), 1e-9));
  CHECK((place(places, 1, 0) - centre).isApprox(height * Eigen::Vector3d(0.1, 0.02, -0.01), 1e-9));
  CHECK(place(places, 0, 1).isApprox(Eigen::Vector3d(0, 85, 0), 1e-9));  // halfway
  CHECK(place(places, 0, 4).array().isNaN().all());                      // it has no toes
}

TEST_CASE("where the rest pose does not stand, the joints' axes follow from the clip") {
  const Motion motion = test::standing_still(test::role_body(), 3);
  const SkeletonRoles roles = test::roles_of_role_body();
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(1.6, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const MatrixD wanted = keypoint_places(motion, roles, kSet),
                places = keypoint_places(with_other_axes(motion, turn), roles, kSet);
  CHECK(places.leftCols(12).isApprox(wanted.leftCols(12), 1e-6));
}

TEST_CASE("a detector sees its joints where the camera has them, and none outside the image") {
  const Motion motion = test::standing_still(test::role_body(), 4);
  const SkeletonRoles roles = test::roles_of_role_body();
  CameraPlacement placement;
  placement.distance = 400;
  Camera camera = place_camera(motion, placement);
  const Track2d exact = test::project_keypoints(motion, roles, kSet, camera);
  CHECK(exact.joint_names == std::vector<std::string>{"Nose", "MidHip", "LKnee", "RKnee", "LToe"});
  CHECK(exact.keypoints.size() == 5);
  const Track2d joints = project_motion(motion, camera);
  CHECK(exact.x_px.col(2).isApprox(joints.x_px.col(joints.find("LeftLeg"))));
  CHECK(exact.y_px.col(2).isApprox(joints.y_px.col(joints.find("LeftLeg"))));
  CHECK(exact.confidence.leftCols(4).isOnes());
  CHECK(exact.confidence.col(4).isZero());
  CHECK(exact.x_px.col(4).array().isNaN().all());

  camera.cy_px -= 500;  // the head is above the image
  const Track2d cut = test::project_keypoints(motion, roles, kSet, camera);
  CHECK(cut.confidence.col(0).isZero());
  CHECK(cut.y_px.col(0).array().isNaN().all());
  CHECK(cut.confidence.col(2).isOnes());
}

TEST_CASE("a detector that is like a track never sees what no frame of the track shows") {
  const Motion motion = test::standing_still(test::role_body(), 40);
  const SkeletonRoles roles = test::roles_of_role_body();
  const Camera camera = place_camera(motion, {});
  Track2d model = test::project_keypoints(motion, roles, kSet, camera);
  for (const Eigen::Index never : {0, 1}) model.confidence.col(never).setZero();
  const Track2d track =
      detector_track(motion, roles, seen_keypoints(model), camera, DetectorNoise{}, 1);
  CHECK(track.joint_names == model.joint_names);
  CHECK(track.confidence.leftCols(2).isZero());
  CHECK(track.x_px.leftCols(2).array().isNaN().all());
  CHECK((track.confidence.middleCols(2, 2).array() > 0).any());
}

TEST_CASE("a detector's noise is a share of the body's height in the image") {
  const Motion motion = test::standing_still(test::role_body(), 400);
  const SkeletonRoles roles = test::roles_of_role_body();
  DetectorNoise noise;
  noise.stray = noise.stray_hidden = noise.lost = noise.lost_hidden = noise.hidden = 0;
  noise.swapped_legs = noise.swapped_arms = 0;
  const auto off_px = [&](double distance) {
    CameraPlacement placement;
    placement.distance = distance;
    const Camera camera = place_camera(motion, placement);
    return MatrixD(detector_track(motion, roles, kSet, camera, noise, 3).x_px -
                   test::project_keypoints(motion, roles, kSet, camera).x_px)
        .leftCols(4)
        .eval();
  };
  const MatrixD near = off_px(500), far = off_px(1000);
  CHECK(near.norm() / std::sqrt(static_cast<double>(near.size())) >
        0.003 * body_height(motion.skeleton) * 1000 / 500);
  CHECK(near.isApprox(2 * far, 0.05));
}

TEST_CASE("a detector loses more of what the body hides from this camera") {
  const Motion motion = test::standing_still(test::role_body(), 600);
  const SkeletonRoles roles = test::roles_of_role_body();
  CameraPlacement from_left;
  from_left.azimuth_deg = 90;
  from_left.elevation_deg = 0;
  const Camera camera = place_camera(motion, from_left);
  DetectorNoise noise;
  noise.lost_hidden = 0.4;
  const Track2d track = detector_track(motion, roles, kSet, camera, noise, 1),
                again = detector_track(motion, roles, kSet, camera, noise, 1),
                other = detector_track(motion, roles, kSet, camera, noise, 2);
  const auto lost = [&](Eigen::Index column) {
    return (track.confidence.col(column).array() == 0).cast<double>().mean();
  };
  CHECK(lost(3) > 0.25);  // the right knee, behind the left one
  CHECK(lost(2) < 0.05);
  CHECK(same(track.x_px, again.x_px));
  CHECK(same(track.confidence, again.confidence));
  CHECK(!same(track.x_px, other.x_px));
}

}  // namespace detector_track_test
