// Where a fitted clip stands, and whose body it moves, step by step.

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "camera/track_noise.hpp"
#include "features/clip_modalities.hpp"
#include "fitting/root_trajectory.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"

namespace known_clip_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A walk of four seconds seen from one side, and a track of it that is a little off.
struct Scene {
  Motion truth = synthesize({.seconds = 4});
  CameraPlacement view{55, 14, std::nullopt, 38, 1280, 721};
  Modalities modalities = modalities_of({truth}, view);
  Camera camera = place_camera(truth, view);
  Track2d track = project_motion(truth, camera);
  MatrixF pose = modalities.encode_pose(truth, camera.camera_from_world);

  Motion placed(const KnownOfClip& known, const std::optional<TrackFitSettings>& fit) const {
    return fit_to_track(pose, modalities, track, known, fit).motion;
  }
  std::string root() const { return modalities.root_name(); }
};

/// A camera of the model's view as the track's image size has it, at the world's origin.
Camera camera_of_view(const Scene& scene) {
  Camera camera;
  camera.camera_from_world = camera_rotation(scene.view.azimuth_deg, scene.view.elevation_deg);
  camera.width_px = scene.track.width_px;
  camera.height_px = scene.track.height_px;
  camera.fx_px = camera.fy_px =
      scene.track.height_px / 2.0 / std::tan(scene.view.field_of_view_deg / 2.0 * EIGEN_PI / 180.0);
  camera.cx_px = scene.track.width_px / 2.0;
  camera.cy_px = scene.track.height_px / 2.0;
  return camera;
}

/// Channels of all joints but the root's position.
MatrixD turns_of(const Motion& motion, const std::string& root) {
  MatrixD turns = motion.channels;
  const int joint = motion.skeleton.find(root);
  for (std::size_t k = 0;
       k < motion.skeleton.joints[static_cast<std::size_t>(joint)].channels.size(); ++k)
    if (!is_rotation(motion.skeleton.joints[static_cast<std::size_t>(joint)].channels[k]))
      turns.col(motion.skeleton.first_channel(joint) + static_cast<Eigen::Index>(k)).setZero();
  return turns;
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("known of a clip: without a fit the answer's joints are decoded as they are") {
  const Scene scene;
  const Modalities& m = scene.modalities;
  const Motion got = scene.placed({scene.camera, scene.truth.skeleton}, std::nullopt);
  const MatrixD features = m.pose_scale.invert(scene.pose);
  const auto decoded = [&](const MatrixD& root) {
    return m.pose_features.decode(features, scene.camera.camera_from_world, scene.truth.skeleton,
                                  m.fps, root);
  };
  std::vector<std::string> names = m.track_features.joint_names();
  names.push_back(scene.root());
  const MatrixD about =
      joints_about(decoded(MatrixD::Zero(scene.truth.frames(), 3)), names, scene.root());
  // The features' velocity is in the camera's axes and in metres on a 1.7 m body.
  const MatrixD velocity = file_units_per_metre(scene.truth.skeleton) *
                           m.pose_features.root_features(features).rightCols(3) *
                           scene.camera.camera_from_world;
  const TrackRays seen = track_rays(names, scene.track, scene.camera);
  const MatrixD root = root_trajectory(about, seen, scene.camera, velocity).root;
  CHECK(largest(got.channels - decoded(root).channels) < 1e-9);
  CHECK(got.fps() == doctest::Approx(m.fps));
  // And that is the truth, as the answer was: a walk of some metres.
  CHECK(largest(path_of(got, scene.root()) - path_of(scene.truth, scene.root())) < 1.0);
  CHECK(largest(joint_positions(got) - joint_positions(scene.truth)) < 1.0);
}

TEST_CASE("known of a clip: without a camera it is the model's view with the track's image") {
  Scene scene;
  add_pixel_noise(scene.track, 2.0, 5);
  for (const bool fit : {false, true}) {
    CAPTURE(fit);
    const auto settings = fit ? std::optional(TrackFitSettings{}) : std::nullopt;
    const Motion got = scene.placed({}, settings);
    const Motion there = scene.placed({camera_of_view(scene), std::nullopt}, settings);
    CHECK(largest(turns_of(got, scene.root()) - turns_of(there, scene.root())) < 1e-9);
    // The same path, but for where it stands: above the origin at first, as high on average as
    // in the answer.
    const MatrixD path = path_of(got, scene.root()), other = path_of(there, scene.root());
    const MatrixD shift = path - other;
    CHECK(largest(shift.rowwise() - shift.row(0)) < 1e-9);
    CHECK(std::abs(path(0, 0)) < 1e-9);
    CHECK(std::abs(path(0, 2)) < 1e-9);
    if (fit) continue;
    const double height = path_of(scene.truth, scene.root()).col(1).mean();
    CHECK(std::abs(path.col(1).mean() - height) < 0.01);
  }
}

TEST_CASE("known of a clip: the root's travel is kept where no camera is given") {
  const Scene scene;
  const MatrixD truth = path_of(scene.truth, scene.root());
  REQUIRE((truth.bottomRows(1) - truth.topRows(1)).norm() > 200);  // cm
  for (const bool fit : {false, true}) {
    CAPTURE(fit);
    const auto settings = fit ? std::optional(TrackFitSettings{}) : std::nullopt;
    const Motion placed = scene.placed({std::nullopt, scene.truth.skeleton}, settings);
    const MatrixD got = path_of(placed, scene.root());
    const MatrixD travel = got.rowwise() - got.row(0), want = truth.rowwise() - truth.row(0);
    CHECK(largest(travel - want) < 5.0);  // of some metres
  }
}

TEST_CASE("known of a clip: an unknown body gets the lengths that the track shows") {
  Scene scene;
  // The track shows someone with thighs a tenth longer and forearms a tenth shorter.
  Motion other = scene.truth;
  const auto lengthen = [](Skeleton& skeleton, const char* end, double factor) {
    for (Joint& joint : skeleton.joints)
      if (joint.name.ends_with(end)) joint.offset *= factor;
  };
  lengthen(other.skeleton, "Leg", 1.1);
  lengthen(other.skeleton, "Hand", 0.9);
  scene.track = project_motion(other, scene.camera);
  const Skeleton& own = scene.truth.skeleton;
  const auto length = [](const Skeleton& skeleton, const char* joint) {
    return skeleton.joints[static_cast<std::size_t>(skeleton.find(joint))].offset.norm();
  };
  const auto got = scene.placed({scene.camera, std::nullopt}, TrackFitSettings{}).skeleton;
  for (const std::string side : {"Left", "Right"}) {
    CAPTURE(side);
    const std::string hand = side + "Hand", leg = side + "Leg", thigh = side + "UpLeg";
    const auto ratio = [&](const std::string& joint) {
      return length(got, joint.c_str()) / length(own, joint.c_str());
    };
    // Near the camera or long: only what bones are to each other shows.
    CHECK(ratio(leg) / ratio(hand) > 1.1);
    CHECK(ratio(leg) / ratio(hand) < 1.3);
  }
  CHECK(length(got, "LeftHand") / length(own, "LeftHand") ==
        doctest::Approx(length(got, "RightHand") / length(own, "RightHand")));
  // A camera does not show how large a body is: it stays one of 1.7 m, so that the camera's
  // metres are its own, and is seen where the track shows it.
  CHECK(body_height(got) == doctest::Approx(body_height(own)));
  Camera camera = scene.camera;
  camera.unit_m = 1 / file_units_per_metre(own);
  const FittedClip clip = fit_to_track(scene.pose, scene.modalities, scene.track,
                                       {camera, std::nullopt}, TrackFitSettings{});
  const Track2d seen = project_motion(clip.motion, in_file_units(camera, clip.motion.skeleton));
  CHECK(largest(seen.x_px - clip.shown.x_px) < 1e-6);
  // To within what a detector is usually off: of an unknown body no track is taken for exact.
  const double height_px =
      (scene.track.y_px.rowwise().maxCoeff() - scene.track.y_px.rowwise().minCoeff()).mean();
  CHECK(largest(seen.x_px - scene.track.x_px) <
        TrackFitSettings{}.detector_noise_heights * height_px);
  // Who is known stays who they are.
  const auto known = scene.placed({scene.camera, own}, TrackFitSettings{}).skeleton;
  CHECK(length(known, "LeftHand") == length(own, "LeftHand"));
  CHECK(length(known, "LeftLeg") == length(own, "LeftLeg"));
}

TEST_CASE("known of a clip: a detector's keypoints are met less exactly than a projection") {
  const Scene scene;
  KnownOfClip known{scene.camera, scene.truth.skeleton};
  const auto off_px = [&] {
    // A pose that is wrong in every frame.
    const MatrixF prior = scene.pose.array() + 0.3F;
    const Track2d shown =
        fit_to_track(prior, scene.modalities, scene.track, known, TrackFitSettings{}).shown;
    double squares = 0;
    for (const std::string& name : scene.modalities.track_features.joint_names())
      squares += (shown.x_px.col(shown.find(name)) - scene.track.x_px.col(scene.track.find(name)))
                     .squaredNorm();
    return std::sqrt(squares / static_cast<double>(scene.track.x_px.size()));
  };
  const double projected_px = off_px();
  known.detected = true;
  CHECK(off_px() > 2 * projected_px);
}

TEST_CASE("known of a clip: motion goes onto the skeleton that is given") {
  const Scene scene;
  Skeleton larger = scene.truth.skeleton;
  for (Joint& joint : larger.joints) {
    joint.offset *= 1.25;
    for (Eigen::Vector3d& end : joint.end_sites) end *= 1.25;
  }
  for (const bool camera : {true, false}) {
    KnownOfClip known{std::nullopt, larger};
    if (camera) known.camera = scene.camera;
    const Motion got = scene.placed(known, std::nullopt);
    for (std::size_t j = 0; j < larger.joints.size(); ++j)
      CHECK(got.skeleton.joints[j].offset == larger.joints[j].offset);
    const auto names = scene.modalities.track_features.joint_names();
    CHECK(largest(joints_about(got, names, scene.root()) -
                  1.25 * joints_about(scene.truth, names, scene.root())) < 0.1);
    if (camera) continue;
    // In its own units it stands as high as in the answer, in metres on a 1.7 m body.
    const double height = path_of(scene.truth, scene.root()).col(1).mean();
    CHECK(std::abs(path_of(got, scene.root()).col(1).mean() - 1.25 * height) < 0.1);
  }
}

}  // namespace known_clip_test
