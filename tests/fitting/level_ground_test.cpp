// Pitch and roll of a camera that nobody calibrated, told by feet on level ground.
#include "fitting/level_ground.hpp"

#include <doctest/doctest.h>

#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/turned_motion.hpp"

using namespace mcdbn;

namespace {

constexpr double kDegree = EIGEN_PI / 180, kAzimuth_deg = 35;

/// Of a camera of that pitch and roll, as the program turns them.
Eigen::Matrix3d camera_from_world(double pitch_deg, double roll_deg) {
  return Eigen::AngleAxisd(-roll_deg * kDegree, Eigen::Vector3d::UnitZ()) *
         camera_rotation(kAzimuth_deg, pitch_deg);
}

/// A motion as a camera of that pitch and roll shows it to somebody who takes it for level.
FittedClip taken_for_level(const Motion& motion, double pitch_deg, double roll_deg) {
  Camera camera = place_camera(motion, {kAzimuth_deg, pitch_deg, std::nullopt, 45, 1920, 1080});
  const Eigen::Vector3d centre = -camera.camera_from_world.transpose() * camera.translation;
  camera.camera_from_world = camera_from_world(0, 0);
  const Eigen::Matrix3d taken_from_true =
      camera.camera_from_world.transpose() * camera_from_world(pitch_deg, roll_deg);
  camera.translation = -camera.camera_from_world * taken_from_true * centre;
  return {turned_motion(motion, taken_from_true), {}, camera};
}

/// How far the ground that the view makes level falls along a direction of the world.
double fall_deg(const AssumedView& view, double pitch_deg, double roll_deg,
                const Eigen::Vector3d& direction) {
  const Eigen::Vector3d up = camera_from_world(*view.pitch_deg, *view.roll_deg).col(1);
  return std::asin(up.dot(camera_from_world(pitch_deg, roll_deg) * direction)) / kDegree;
}

Eigen::Vector3d way_of(const Motion& walk) {
  const MatrixD positions = joint_positions(walk);
  const RowVectorD way = positions.row(positions.rows() - 1) - positions.row(0);
  return way.head<3>().transpose().normalized();
}

const std::vector<double> kPitches_deg{-8, 0, 12, 25};

}  // namespace

TEST_CASE("level ground: a walk tells how its camera looks") {
  const Motion walk = synthesize({.seconds = 6});
  for (const double pitch_deg : kPitches_deg) {
    CAPTURE(pitch_deg);
    const AssumedView view = levelled_view({}, taken_for_level(walk, pitch_deg, 0));
    CHECK(std::abs(*view.pitch_deg - pitch_deg) < 0.5);
    CHECK(std::abs(*view.roll_deg) < 0.5);
    // One way tells of one slope: what is across it is what cameras are like.
    for (const double roll_deg : {4.0, -3.0}) {
      CAPTURE(roll_deg);
      const AssumedView rolled = levelled_view({}, taken_for_level(walk, pitch_deg, roll_deg));
      CHECK(std::abs(fall_deg(rolled, pitch_deg, roll_deg, way_of(walk))) < 0.7);
      CHECK(std::abs(*rolled.pitch_deg - pitch_deg) < 4);
      CHECK(std::abs(*rolled.roll_deg - roll_deg) < std::abs(roll_deg) + 0.5);
    }
  }
}

TEST_CASE("level ground: who stays where they are is balanced over their feet") {
  for (const SynthesisAction action : {SynthesisAction::wave_one, SynthesisAction::jump}) {
    const Motion motion = synthesize({.action = action, .seconds = 6});
    const auto pitch_of = [&](double pitch_deg) {
      return *levelled_view({}, taken_for_level(motion, pitch_deg, 0)).pitch_deg;
    };
    const double level = pitch_of(0);
    CHECK(std::abs(level) < 5);
    for (const double pitch_deg : kPitches_deg) {
      const double share = (pitch_of(pitch_deg) - level) / pitch_deg;
      if (pitch_deg != 0) CHECK(std::abs(share - 0.75) < 0.1);
    }
  }
}

TEST_CASE("level ground: what was said stays, and without feet what was assumed") {
  FittedClip clip = taken_for_level(synthesize({.seconds = 4}), 12, 0);
  AssumedView said;
  said.field_of_view_deg = 50;
  said.pitch_deg = 3;
  said.roll_deg = -2;
  AssumedView view = levelled_view(said, clip);
  CHECK(view.pitch_deg == 3);
  CHECK(view.roll_deg == -2);
  CHECK(view.field_of_view_deg == 50);
  said.pitch_deg.reset();
  view = levelled_view(said, clip);
  CHECK(std::abs(*view.pitch_deg - 12) < 2);
  CHECK(view.roll_deg == -2);
  for (Joint& joint : clip.motion.skeleton.joints) joint.name = "bone";
  view = levelled_view(said, clip);
  CHECK_FALSE(view.pitch_deg);
}
