// Films that are stored turned, and people who only look as if.
#include "camera/quarter_roll.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera/keypoint_track.hpp"
#include "camera/role_body.hpp"

namespace quarter_roll_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using enum JointRole;

/// Where the joints of a figure are that is seen from the side, in px.
struct Figure {
  Eigen::Vector2d shoulder{0, -50}, hip{0, 0}, knee{0, 45}, ankle{0, 90};
};

/// So many frames of it, the image turned clockwise by that angle.
Track2d seen(const Figure& figure, int frames, double clockwise_deg) {
  const std::vector<std::pair<JointRole, Eigen::Vector2d>> joints{
      {left_shoulder, figure.shoulder}, {right_shoulder, figure.shoulder},
      {left_hip, figure.hip},           {right_hip, figure.hip},
      {left_knee, figure.knee},         {right_knee, figure.knee},
      {left_ankle, figure.ankle},       {right_ankle, figure.ankle}};
  const double angle = clockwise_deg * std::numbers::pi / 180;
  Track2d track;
  const auto count = static_cast<Eigen::Index>(joints.size());
  track.x_px = track.y_px = track.confidence = MatrixD::Ones(frames, count);
  for (const auto& [role, place] : joints) {
    const auto column = static_cast<Eigen::Index>(track.joint_names.size());
    track.keypoints.push_back(keypoint(std::string(name_of(role)), role));
    track.joint_names.push_back(track.keypoints.back().name);
    // y is down, so that x turns to y.
    track.x_px.col(column).setConstant(500 + std::cos(angle) * place.x() -
                                       std::sin(angle) * place.y());
    track.y_px.col(column).setConstant(500 + std::sin(angle) * place.x() +
                                       std::cos(angle) * place.y());
  }
  return track;
}

void hide(Track2d& track, int frames, JointRole left) {
  for (std::size_t column = 0; column < track.keypoints.size(); ++column)
    if (track.keypoints[column].role == left || track.keypoints[column].role == other_side(left))
      track.confidence.col(static_cast<Eigen::Index>(column)).head(frames).setZero();
}

}  // namespace

TEST_CASE("quarter roll: a film turned clockwise needs a camera turned the other way") {
  for (const Figure& figure : {Figure{}, Figure{.knee = {45, 0}, .ankle = {45, 45}}}) {
    CAPTURE(figure.knee.x());  // stands, or sits on a chair
    CHECK(quarter_roll_deg(seen(figure, 3, 0)) == std::nullopt);
    CHECK(quarter_roll_deg(seen(figure, 3, 90)) == -90);
    CHECK(quarter_roll_deg(seen(figure, 3, 180)) == 180);
    CHECK(quarter_roll_deg(seen(figure, 3, 270)) == 90);
  }
  for (const double tilt_deg : {-40, -10, 10, 40}) {
    CHECK(quarter_roll_deg(seen({}, 3, tilt_deg)) == std::nullopt);
    CHECK(quarter_roll_deg(seen({}, 3, 90 + tilt_deg)) == -90);
  }
}

TEST_CASE("quarter roll: it is the roll of the camera that filmed") {
  const Motion motion = standing_still(role_body(), 2);
  for (const int roll_deg : {0, 90, 180, -90}) {
    CAPTURE(roll_deg);
    Camera camera = place_camera(motion, {});
    // The camera's axes turn clockwise, seen from behind: about z, from x (right) to y (down).
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(roll_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    camera.camera_from_world = turn.transpose() * camera.camera_from_world;
    camera.translation = turn.transpose() * camera.translation;
    CHECK(quarter_roll_deg(keypoint_track(motion, camera, coco_keypoints())).value_or(0) ==
          roll_deg);
  }
}

TEST_CASE("quarter roll: who bends forward or sits on the ground is upright") {
  CHECK(quarter_roll_deg(seen({.shoulder = {50, 5}}, 3, 0)) == std::nullopt);
  CHECK(quarter_roll_deg(seen({.knee = {45, 0}, .ankle = {90, 0}}, 3, 0)) == std::nullopt);
}

TEST_CASE("quarter roll: what is seen of trunk and legs decides, in most frames") {
  for (const std::vector<JointRole>& hidden :
       std::vector<std::vector<JointRole>>{{left_ankle},
                                           {left_knee, left_ankle},
                                           {left_shoulder},
                                           {left_shoulder, left_ankle},
                                           {left_hip},
                                           {left_hip, left_ankle}}) {
    Track2d track = seen({}, 3, 90);
    for (const JointRole joint : hidden) hide(track, 3, joint);
    CHECK(quarter_roll_deg(track) == -90);
  }
  Track2d shoulders = seen({}, 3, 90);
  for (const JointRole joint : {left_hip, left_knee, left_ankle}) hide(shoulders, 3, joint);
  CHECK(quarter_roll_deg(shoulders) == std::nullopt);
  // Upright in two frames of four, and then in two of five.
  const Track2d upright = seen({}, 2, 0);
  for (const int turned : {2, 3}) {
    Track2d track = seen({}, 2 + turned, 90);
    track.x_px.topRows(2) = upright.x_px;
    track.y_px.topRows(2) = upright.y_px;
    CHECK(quarter_roll_deg(track).has_value() == (turned == 3));
    // Frames that show nothing do not count.
    for (const JointRole joint : {left_shoulder, left_hip, left_knee, left_ankle})
      hide(track, 2, joint);
    CHECK(quarter_roll_deg(track) == -90);
  }
  Track2d nameless = seen({}, 3, 90);
  nameless.keypoints.clear();
  CHECK(quarter_roll_deg(nameless) == std::nullopt);
}

}  // namespace quarter_roll_test
