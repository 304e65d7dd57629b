// Which view the features are of: the camera's own or its level one.

#include "mcdbn/features/modalities.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "features/clip_modalities.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/level_view.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kRadians = std::numbers::pi / 180;

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

struct Scene {
  Motion clip = swinging(small_body(), 40);
  CameraPlacement view{35, 12, std::nullopt, 45, 1280, 720};
  Modalities modalities = modalities_of({clip}, view);
  Camera upright = place_camera(clip, {35, 0, std::nullopt, 45, 1280, 720});
  Camera tilted = upright;  // at the same place, its lens another one

  Scene() {
    modalities.level_view = true;
    const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-0.15, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    tilted.camera_from_world = tilt * upright.camera_from_world;
    tilted.translation = tilt * upright.translation;
    tilted.fx_px = 900;
    tilted.fy_px = 950;
    tilted.cx_px = 600;
    tilted.distortion = {-0.1, 0.02, 0.001, -0.002};
  }
};

}  // namespace

TEST_CASE(
    "modalities: in the level view a tilted camera with a lens sees what an upright one does") {
  const Scene scene;
  const Modalities& m = scene.modalities;
  const Track2d track = project_motion(scene.clip, scene.tilted);
  const MatrixF wanted =
      m.track_scale.apply(m.track_features.encode(project_motion(scene.clip, scene.upright)));
  CHECK((m.encode_track(track, scene.tilted) - wanted).cwiseAbs().maxCoeff() < 1e-3);
  const MatrixD poses = m.pose_features.encode(scene.clip, camera_rotation(35, 0));
  CHECK(largest(m.pose_values(scene.clip, scene.tilted.camera_from_world) - poses) < 1e-12);
  CHECK(m.encode_pose(scene.clip, scene.tilted.camera_from_world) ==
        m.pose_scale.apply(m.pose_values(scene.clip, scene.tilted.camera_from_world)));
  const MatrixF pose = m.encode_pose(scene.clip, scene.tilted.camera_from_world);
  CHECK(largest(m.pose_in_camera(pose, scene.tilted.camera_from_world) -
                m.pose_features.encode(scene.clip, scene.tilted.camera_from_world)) < 1e-5);
  const Track2d back = m.decode_track(wanted, scene.tilted);
  for (int j = 0; j < back.joint_count(); ++j) {
    const int column = track.find(back.joint_names[static_cast<std::size_t>(j)]);
    CHECK(largest(back.x_px.col(j) - track.x_px.col(column)) < 0.05);
    CHECK(largest(back.y_px.col(j) - track.y_px.col(column)) < 0.05);
  }
}

TEST_CASE("modalities: what the level view does not show is counted apart from what is missing") {
  const Scene scene;
  const Modalities& m = scene.modalities;
  const Camera steep = place_camera(scene.clip, {35, 80, std::nullopt, 45, 1280, 720});
  Track2d track = project_motion(scene.clip, steep);
  // By the angle in the world between the heading and the way from the camera to the joint.
  const Eigen::Vector3d place = -steep.camera_from_world.transpose() * steep.translation;
  Eigen::Vector3d heading = steep.camera_from_world.row(2).transpose();
  heading.y() = 0;
  const MatrixD positions = joint_positions(scene.clip);
  std::vector<std::string> names = m.track_features.joint_names();
  names.push_back(m.root_name());
  const auto is_outside = [&](int frame, const std::string& name) {
    const Eigen::Vector3d to_joint =
        positions.row(frame).segment<3>(3 * scene.clip.skeleton.find(name)).transpose() - place;
    return to_joint.normalized().dot(heading.normalized()) <= kLevelViewLeastCosine;
  };
  int outside = 0;
  for (int frame = 0; frame < scene.clip.frames(); ++frame)
    for (const std::string& name : names) outside += is_outside(frame, name) ? 1 : 0;
  REQUIRE(outside > 0);
  REQUIRE(outside < scene.clip.frames() * static_cast<int>(names.size()));
  TrackFeatures::FillCount filled;
  m.track_values(track, steep, &filled);
  CHECK(filled.outside == outside);
  CHECK(filled.interpolated + filled.missing == 0);
  CHECK(filled.unseen.empty());
  // What the track itself does not show is missing and no more.
  const int lost = 12;
  int lost_outside = 0;
  for (int frame = 0; frame < lost; ++frame) lost_outside += is_outside(frame, "LHand") ? 1 : 0;
  track.confidence.col(track.find("LHand")).head(lost).setZero();
  m.track_values(track, steep, &filled);
  CHECK(filled.missing == lost);
  CHECK(filled.outside == outside - lost_outside);
  // From the side all of it is in the view.
  m.track_values(project_motion(scene.clip, scene.upright), scene.upright, &filled);
  CHECK(filled.outside == 0);
}

TEST_CASE("modalities: without a level view the features are of the camera's own") {
  Scene scene;
  Modalities& m = scene.modalities;
  m.level_view = false;
  const Track2d track = project_motion(scene.clip, scene.tilted);
  CHECK(m.track_values(track, scene.tilted) == m.track_features.encode(track));
  CHECK(m.pose_axes(scene.tilted.camera_from_world) == scene.tilted.camera_from_world);
  const MatrixF row = MatrixF::Zero(2, m.track_scale.output_dimension());
  CHECK(m.decode_track(row, scene.tilted).x_px ==
        m.track_features.decode(m.track_scale.invert(row), m.fps, 1280, 720).x_px);
}

TEST_CASE(
    "modalities: an unknown camera is level, of a usual lens, and heads where the model's does") {
  const Scene scene;
  const Modalities& m = scene.modalities;
  const Camera assumed = m.assumed_camera({}, 1600, 1200);
  CHECK(largest(assumed.camera_from_world - camera_rotation(35, 0)) < 1e-12);
  CHECK(assumed.translation.norm() == 0);
  CHECK(assumed.fx_px == doctest::Approx(800 / std::tan(30 * kRadians)));
  CHECK(assumed.fy_px == assumed.fx_px);
  CHECK(assumed.cx_px == 800);
  CHECK(assumed.cy_px == 600);
  CHECK(m.assumed_camera({}, 1200, 1600).fy_px == doctest::Approx(assumed.fx_px));
  // What is known of it: the person's feet come nearer where it looks down, and clockwise of the
  // image's own axes is counter-clockwise in the image.
  const AssumedView view{20, 10, 40};
  const Camera known = m.assumed_camera(view, 1600, 1200);
  CHECK(known.fy_px == doctest::Approx(600 / std::tan(20 * kRadians)));
  CHECK(known.camera_from_world.row(2).y() == doctest::Approx(-std::sin(20 * kRadians)));
  const Eigen::Vector3d up = known.camera_from_world * Eigen::Vector3d::UnitY();
  CHECK(std::atan2(up.x(), -up.y()) == doctest::Approx(-10 * kRadians));
  // A model without a level view has its own view alone.
  Modalities old = m;
  old.level_view = false;
  CHECK(largest(old.assumed_camera({}, 1280, 720).camera_from_world - camera_rotation(35, 12)) <
        1e-12);
  CHECK(old.assumed_camera({}, 1280, 720).fy_px ==
        doctest::Approx(360 / std::tan(22.5 * kRadians)));
  CHECK_THROWS_AS(m.assumed_camera({90, {}, {}}, 1280, 720), ConfigError);
  CHECK_THROWS_AS(m.assumed_camera({{}, 181, {}}, 1280, 720), ConfigError);
  CHECK_THROWS_AS(m.assumed_camera({{}, {}, 0}, 1280, 720), ConfigError);
}

TEST_CASE("pose features: poses along the axes of another camera") {
  const Scene scene;
  const PoseFeatures& features = scene.modalities.pose_features;
  const Eigen::Matrix3d other = camera_rotation(80, -20), one = camera_rotation(-10, 30);
  const MatrixD turned = features.turned(features.encode(scene.clip, one), other * one.transpose());
  CHECK(largest(turned - features.encode(scene.clip, other)) < 1e-9);
  CHECK_THROWS_AS(features.turned(MatrixD::Zero(2, 3), one), ShapeError);
}
