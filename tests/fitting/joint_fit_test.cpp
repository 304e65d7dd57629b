#include "fitting/joint_fit.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "camera/track_noise.hpp"
#include "fitting/frame_fit.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/two_second_walk.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/foot_joints.hpp"

using namespace mcdbn;

namespace {

/// Of the turns by which answers are wrong: their size, and how alike they are along a limb.
/// Neither is the fit's own number, and it is not told.
constexpr double kWrong_deg = 12, kAlike = 0.3;

/// A walk, its 2D track through a lens with distortion, and an answer that is wrong by turns, a
/// little alike along a limb, and by a misplaced root.
struct Scene {
  Motion truth;
  Camera camera;
  Track2d track;
  PoseFeatures pose_features;
  MatrixD features, root;  ///< of the answer

  Motion decode(const MatrixD& of) const {
    return pose_features.decode(of, camera.camera_from_world, truth.skeleton, truth.fps(), root);
  }
  MatrixD fit(const TrackFitSettings& options = {}) const { return fit(track, options); }
  MatrixD fit(const Track2d& seen, const TrackFitSettings& options = {}) const {
    const auto turns = static_cast<Eigen::Index>(pose_features.joints().size());
    return fit(seen, MatrixD::Constant(features.rows(), turns, 25 * M_PI / 180), options);
  }
  MatrixD fit(const Track2d& seen, const MatrixD& turn_deviation_rad,
              const TrackFitSettings& options = {}) const {
    return fit_joints(pose_features, features, turn_deviation_rad, decode(features),
                      track_rays(track.joint_names, seen, camera), track_noise_px(seen), camera,
                      options);
  }
};

MatrixD disturbed(MatrixD features, const FramePrior& prior, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> turns;
  for (const int parent : prior.parents) {
    const double own = parent < 0 ? 1 : std::sqrt(1 - prior.likeness * prior.likeness);
    Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    turn *= own * prior.turn_deviation_rad.front();
    if (parent >= 0) turn += prior.likeness * turns[parent];
    const auto block = static_cast<Eigen::Index>(6 * turns.size());
    for (Eigen::Index t = 0; t < features.rows(); ++t) {
      for (const Eigen::Index axis : {block, block + 3}) {
        features.row(t).segment<3>(axis) *= rotation_of(turn).transpose();
      }
    }
    turns.push_back(turn);
  }
  return features;
}

/// @param seed 0: the answer is the truth
Scene make_scene(unsigned seed = 1, int frames = 60, double scale = 1) {
  Scene scene;
  scene.truth = test::two_second_walk();
  scene.truth.channels.conservativeResize(frames, Eigen::NoChange);
  scene.truth.channels.leftCols<3>() *= scale;
  for (Joint& joint : scene.truth.skeleton.joints) {
    joint.offset *= scale;
    for (Eigen::Vector3d& end : joint.end_sites) end *= scale;
  }
  scene.camera = place_camera(scene.truth, {});
  scene.camera.distortion = {-0.1, 0.02, 1e-3, -5e-4};
  scene.track = project_motion(scene.truth, scene.camera);
  scene.pose_features = PoseFeatures::fit({&scene.truth});
  scene.features = scene.pose_features.encode(scene.truth, scene.camera.camera_from_world);
  scene.root = joint_positions(scene.truth).leftCols<3>();
  if (seed == 0) return scene;
  FramePrior prior;
  prior.likeness = kAlike;
  prior.turn_deviation_rad = {kWrong_deg * M_PI / 180};  // of every turn
  const Skeleton& skeleton = scene.pose_features.skeleton();
  const std::vector<int>& joints = scene.pose_features.joints();
  for (int joint : joints) {
    do joint = skeleton.joints[joint].parent;
    while (joint >= 0 && std::find(joints.begin(), joints.end(), joint) == joints.end());
    prior.parents.push_back(
        joint < 0
            ? -1
            : static_cast<int>(std::find(joints.begin(), joints.end(), joint) - joints.begin()));
  }
  scene.features = disturbed(scene.features, prior, seed);
  scene.root.rowwise() += scale * RowVectorD{{3, -2, 5}};
  return scene;
}

/// Mean square distance of the joints from the truth's, relative to the root.
double error(const Scene& scene, const MatrixD& features) {
  MatrixD off = joint_positions(scene.decode(features)) - joint_positions(scene.truth);
  off -= off.leftCols<3>().eval().replicate(1, off.cols() / 3);
  return off.squaredNorm() / static_cast<double>(off.size());
}

/// RMS distance in pixels, of x and y each, between where the camera sees the joints and where
/// `seen` has them, the root where root_trajectory puts it.
double miss_px(const Scene& scene, const MatrixD& features, const Track2d& seen) {
  const MatrixD all = joint_positions(scene.decode(features));
  const MatrixD relative = all - all.leftCols<3>().replicate(1, all.cols() / 3);
  const MatrixD root =
      root_trajectory(relative, track_rays(scene.track.joint_names, scene.track, scene.camera),
                      scene.camera, MatrixD(0, 3));
  const MatrixD made = project_points(scene.camera, relative + root.replicate(1, all.cols() / 3));
  double squares = 0;
  for (int joint = 0; joint < seen.joint_count(); ++joint) {
    squares += (made.col(2 * joint) - seen.x_px.col(joint)).squaredNorm() +
               (made.col(2 * joint + 1) - seen.y_px.col(joint)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(made.size()));
}

double largest(const MatrixD& values) {
  return values.cwiseAbs().maxCoeff();
}

/// From one row to the next.
double largest_step(const MatrixD& values) {
  return (values.bottomRows(values.rows() - 1) - values.topRows(values.rows() - 1))
      .rowwise()
      .norm()
      .maxCoeff();
}

}  // namespace

TEST_CASE("joint fit: disturbed answers come back") {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const Scene scene = make_scene(seed);
    const MatrixD fitted = scene.fit();
    // A camera tells two of three coordinates: were depth not learned at all, a third of the
    // squares would stay.
    CHECK(error(scene, fitted) < error(scene, scene.features) / 3);
    CHECK(miss_px(scene, scene.features, scene.track) > 10);
    // The track is taken to be off by half a pixel; smoothing and the root's own fit add their
    // part.
    CHECK(miss_px(scene, fitted, scene.track) < 1);
    CHECK(fitted.rightCols<4>() == scene.features.rightCols<4>());
    CHECK(scene.fit() == fitted);
  }
}

TEST_CASE("joint fit: an answer that is right stays") {
  const Scene scene = make_scene(0);
  CHECK(largest(scene.fit() - scene.features) < 1e-3);
}

TEST_CASE("joint fit: units do not matter") {
  const MatrixD centimetres = make_scene(1).fit(), metres = make_scene(1, 60, 0.01).fit();
  CHECK(largest(centimetres - metres) < 1e-6);
}

TEST_CASE("joint fit: missing joints are ignored, whatever number stands there") {
  const Scene scene = make_scene();
  Track2d missing = scene.track;
  drop_joints(missing, 0.3, 3);
  const MatrixD fitted = scene.fit(missing);
  CHECK(error(scene, fitted) < error(scene, scene.features) / 3);
  Track2d wild = missing;
  for (Eigen::Index k = 0; k < wild.x_px.size(); ++k) {
    if (wild.confidence.data()[k] == 0) wild.x_px.data()[k] = wild.y_px.data()[k] = 1e5;
  }
  CHECK(scene.fit(wild) == fitted);
  // A joint that the track has and the body has not.
  Track2d more = scene.track;
  more.joint_names.push_back("ghost");
  for (MatrixD* values : {&more.x_px, &more.y_px, &more.confidence}) {
    values->conservativeResize(Eigen::NoChange, values->cols() + 1);
    values->rightCols<1>().setConstant(values == &more.confidence ? 1 : 100);
  }
  const MatrixD with_ghost = scene.fit(more);
  CHECK(error(scene, with_ghost) < error(scene, scene.features) / 3);
  missing.joint_names[3] = "stranger";
  CHECK(error(scene, scene.fit(missing)) < error(scene, scene.features) / 3);
}

TEST_CASE("joint fit: an arm's correction fades where the arm is hidden, and nothing jumps") {
  const Scene scene = make_scene();
  Track2d hidden = scene.track;
  REQUIRE(!hide_arm(hidden, scene.truth.skeleton, 1.2, 1).empty());
  const MatrixD change = scene.fit() - scene.features, faded = scene.fit(hidden) - scene.features;
  // Over some frames, not at once: those that it is remembered, and its neighbours.
  CHECK(largest_step(faded) < change.rowwise().norm().maxCoeff() / 4.5);
  // In the middle of the gap it is gone: 1.2 s are 6 memories to either side.
  const auto names = scene.pose_features.feature_names();
  const Skeleton& skeleton = scene.pose_features.skeleton();
  for (std::size_t turn = 0; turn < scene.pose_features.joints().size(); ++turn) {
    const int joint = scene.pose_features.joints()[turn];
    const int column = hidden.find(skeleton.joints[joint].name);
    const bool end = column >= 0 && hidden.confidence(30, column) == 0;
    if (!end) continue;
    const auto block = static_cast<Eigen::Index>(6 * turn);
    CAPTURE(names[6 * turn]);
    const double before = change.block<1, 6>(30, block).norm();
    if (before > 0.1) CHECK(faded.block<1, 6>(30, block).norm() < before);
  }
}

TEST_CASE("joint fit: neighbours tell bones that lean to the camera from those that lean away") {
  // The answers are wrong by the same turns throughout, so that what jumps is a mistaken lean.
  double alone_squares = 0, beside_squares = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    const Scene scene = make_scene(seed);
    const MatrixD alone = scene.fit({.change = 1e3}), beside = scene.fit();
    CHECK(error(scene, beside) < error(scene, alone));
    CHECK(largest_step(beside - scene.features) < largest_step(alone - scene.features));
    alone_squares += error(scene, alone);
    beside_squares += error(scene, beside);
  }
  CHECK(beside_squares < 0.75 * alone_squares);
}

TEST_CASE("joint fit: a foot that stands stays where it stands") {
  // Someone stands still; at first the answer has the legs where they are not.
  Scene scene = make_scene(0);
  scene.truth.channels.rowwise() = scene.truth.channels.row(0).eval();
  scene.track = project_motion(scene.truth, scene.camera);
  scene.features = scene.pose_features.encode(scene.truth, scene.camera.camera_from_world);
  scene.root = joint_positions(scene.truth).leftCols<3>();
  constexpr int kWrongFrames = 4;
  scene.features.topRows<kWrongFrames>() = make_scene(1).features.topRows<kWrongFrames>();
  const std::vector<int> feet = foot_joints(scene.truth.skeleton);
  REQUIRE(!feet.empty());
  // Mean square of how much too near the camera, or too far from it, they are in those frames.
  const auto off = [&](const TrackFitSettings& options) {
    const MatrixD wrong =
        joint_positions(scene.decode(scene.fit(options))) - joint_positions(scene.truth);
    double squares = 0;
    for (const int foot : feet) {
      const MatrixD depth = wrong.middleCols<3>(3 * foot).topRows<kWrongFrames>() *
                            scene.camera.camera_from_world.row(2).transpose();
      squares += depth.squaredNorm();
    }
    return squares;
  };
  CHECK(off({}) < off({.footing_m = 1e3}) / 4);
}

TEST_CASE("joint fit: a joint that the tracker swapped is let go of") {
  Scene scene = make_scene();
  const double clean = error(scene, scene.fit());
  const int hand = scene.track.find("LeftHand");
  REQUIRE(hand >= 0);
  Track2d swapped = scene.track;
  swapped.x_px.col(hand).array() += 300;
  const double spoiled = error(scene, scene.fit(swapped));
  // The hand itself falls back on the answer; the others must not pay.
  CHECK(spoiled < error(scene, scene.features) / 2);
  CHECK(clean < spoiled);
  // For single frames it does not even do that; by how much differs from answer to answer.
  double clean_sum = 0, swapped_sum = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Scene other = make_scene(seed);
    swapped = other.track;
    swapped.x_px(20, hand) += 300;
    clean_sum += error(other, other.fit());
    swapped_sum += error(other, other.fit(swapped));
  }
  CHECK(swapped_sum < 1.1 * clean_sum);
}

TEST_CASE("joint fit: noise is smoothed away, not followed") {
  const Scene scene = make_scene();
  Track2d noisy = scene.track;
  add_pixel_noise(noisy, 5, 1);
  const MatrixD fitted = scene.fit(noisy);
  CHECK(error(scene, fitted) < error(scene, scene.features) / 2);
  // Nearer to what there was to see than the track itself is.
  CHECK(miss_px(scene, fitted, scene.track) < 5);
}

TEST_CASE("joint fit: nothing to see leaves the answer, bit for bit") {
  Scene scene = make_scene();
  Track2d blind = scene.track;
  drop_joints(blind, 1, 1);
  CHECK(scene.fit(blind) == scene.features);
  blind.joint_names.assign(blind.joint_names.size(), "stranger");
  CHECK(scene.fit(blind) == scene.features);
  scene.camera.translation.z() = -1e4;  // all of the body is behind the camera
  CHECK(scene.fit(scene.track) == scene.features);
}

TEST_CASE("joint fit: a limb behind the camera does not blow up") {
  Scene scene = make_scene();
  // The root half a metre before the camera, some joints behind it.
  const Eigen::Vector3d root = scene.root.row(30).transpose();
  scene.camera.translation = Eigen::Vector3d(0, 0, 30) - scene.camera.camera_from_world * root;
  const MatrixD fitted = scene.fit(scene.track);
  CHECK(fitted.allFinite());
  CHECK(largest(fitted.leftCols(fitted.cols() - 4)) < 1 + 1e-9);  // axes of length 1
}

TEST_CASE("joint fit: one frame, no frame, other shapes") {
  const Scene one = make_scene(1, 1);
  CHECK(error(one, one.fit()) < error(one, one.features) / 3);
  Scene none = make_scene(1, 1);
  none.track.x_px.resize(0, none.track.joint_count());
  none.track.y_px = none.track.confidence = none.track.x_px;
  none.features.conservativeResize(0, Eigen::NoChange);
  none.root.conservativeResize(0, Eigen::NoChange);
  CHECK(none.fit().rows() == 0);
  Scene wrong = make_scene();
  wrong.track.x_px.conservativeResize(9, Eigen::NoChange);
  CHECK_THROWS_AS(wrong.fit(), ShapeError);
}

TEST_CASE("joint fit: with a body of other proportions it does no harm") {
  Scene scene = make_scene();
  const double before = error(scene, scene.features);
  // The track shows someone with legs a tenth longer and arms a tenth shorter.
  Motion other = scene.truth;
  for (Joint& joint : other.skeleton.joints) {
    if (joint.name.ends_with("Leg") || joint.name.ends_with("Foot")) joint.offset *= 1.1;
    if (joint.name.ends_with("ForeArm") || joint.name.ends_with("Hand")) joint.offset *= 0.9;
  }
  const Track2d track = project_motion(other, scene.camera);
  CHECK(error(scene, scene.fit(track, {.proportions_m = 0.05})) < before);
}
