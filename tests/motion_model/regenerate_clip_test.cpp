// From a track to clips: rates, gaps, and every option on its way to its use.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "camera/track_noise.hpp"
#include "camera/track_resample.hpp"
#include "device/every_device.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/level_view.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/body_size.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/resample.hpp"
#include "motion_model/clip_scene.hpp"
#include "motion_model/several_answers.hpp"

namespace regenerate_clip_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A clip at the model's 30 frames a second, and one of another length at another rate, whose
/// track is off by some pixels.
struct Scene {
  Motion training = swinging(small_body(), 60);
  CameraPlacement view{35, 12, std::nullopt, 45, 1920, 1080};
  Modalities modalities = modalities_of({training}, view);
  Motion clip;
  Camera camera;
  Track2d track;

  explicit Scene(double fps, int frames = 50)
      : clip(swinging(small_body(), frames, fps)),
        camera(place_camera(clip, view)),
        track(project_motion(clip, camera)) {
    add_pixel_noise(track, 2.0, 3);
  }
  ClipPlacement placement() const { return {{camera, clip.skeleton}, std::nullopt}; }
  Model model(Device& device) const {
    return {random_network(device, modalities), modalities, {}, {}};
  }
};

RegenerationOptions some_options() {
  RegenerationOptions options;
  options.samples = 2;
  options.temperature = 0.8;
  options.sampling = {.gibbs_steps = 2, .mrbm_gibbs_steps = 3, .steady = true, .scale = 0.9};
  options.seed = 41;
  options.run_in = 7;
  return options;
}

/// Step by step: the track to the model's rate, then its noise out; the motion back to its rate.
std::vector<Motion> step_by_step(const Model& model, const Track2d& track,
                                 const ClipPlacement& placement,
                                 const RegenerationOptions& options) {
  const Track2d at_rate = resample_track(track, model.modalities.fps);
  MatrixF seen = model.modalities.encode_track(smooth_track(at_rate),
                                               placement.camera_of(track, model.modalities));
  seen = fill_gaps(model.modalities, seen, at_rate, placement,
                   [&](const MatrixF& some) { return single_answer(model.network, some); });
  std::vector<Motion> motions;
  for (const MatrixF& pose : regenerate(model.network, {seen}, options))
    motions.push_back(resample(
        fit_to_track(pose, model.modalities, at_rate, placement, placement.fit).motion, track.fps));
  return motions;
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

double pitch_deg(const Camera& camera) {
  return std::asin(-camera.camera_from_world.col(1).z()) * 180 / EIGEN_PI;
}

}  // namespace

TEST_CASE("regenerate_clip: as many frames as the track has, at the track's rate") {
  on_every_device([](Device& device) {
    for (const double fps : {30.0, 47.0, 120.0, 24.0, 15.0, 29.97})
      for (const int frames : {1, 2, 50}) {
        CAPTURE(fps);
        CAPTURE(frames);
        const Scene scene(fps, frames);
        const auto motions =
            regenerate_clip(scene.model(device), scene.track, scene.placement(), {});
        REQUIRE(motions.size() == 1);
        CHECK(motions[0].frames() == frames);
        if (frames > 2) CHECK(motions[0].fps() == doctest::Approx(fps).epsilon(1e-9));
        CHECK(motions[0].channels.allFinite());
      }
  });
}

TEST_CASE("regenerate_clip: every option comes to its use") {
  on_every_device([](Device& device) {
    for (const double fps : {30.0, 47.0, 20.0}) {
      CAPTURE(fps);
      const Scene scene(fps);
      const Model model = scene.model(device);
      const RegenerationOptions options = some_options();
      const auto got = regenerate_clip(model, scene.track, scene.placement(), options);
      const auto want = step_by_step(model, scene.track, scene.placement(), options);
      REQUIRE(got.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        // Beyond the last frame at the model's rate the last one stays.
        const int have = std::min(want[i].frames(), scene.clip.frames());
        CHECK(largest(got[i].channels.topRows(have) - want[i].channels.topRows(have)) < 1e-9);
        for (int t = have; t < got[i].frames(); ++t)
          CHECK(largest(got[i].channels.row(t) - want[i].channels.row(have - 1)) < 1e-9);
      }
      CHECK(largest(got[0].channels - got[1].channels) > 1e-3);
    }
    // Each option alone changes what comes out.
    const Scene scene(30.0);
    const Model model = scene.model(device);
    const auto first = [&](const RegenerationOptions& options, const ClipPlacement& placement) {
      return regenerate_clip(model, scene.track, placement, options).at(0).channels;
    };
    const RegenerationOptions options = some_options();
    const MatrixD usual = first(options, scene.placement());
    CHECK(first(options, scene.placement()) == usual);
    std::vector<RegenerationOptions> others(7, options);
    others[0].seed = 42;
    others[1].temperature = 0.4;
    others[2].sampling.gibbs_steps = 3;
    others[3].sampling.mrbm_gibbs_steps = 1;
    others[4].sampling.steady = false;
    others[5].sampling.scale = 0.45;
    others[6].run_in = 0;
    for (std::size_t i = 0; i < others.size(); ++i) {
      CAPTURE(i);
      CHECK(largest(first(others[i], scene.placement()) - usual) > 1e-4);
    }
    std::vector<ClipPlacement> placements(3, scene.placement());
    placements[0].camera.reset();
    placements[1].fit = TrackFitSettings{};
    placements[2].skeleton->joints[2].offset *= 1.2;
    for (const ClipPlacement& placement : placements)
      CHECK((first(options, placement) - usual).cwiseAbs().maxCoeff() > 1e-4);
  });
}

TEST_CASE(
    "regenerate_clip: gaps are counted, filled from the answer, a lost joint is inferred, no "
    "joints are an error") {
  on_every_device([](Device& device) {
    Scene scene(30.0);
    const Model model = scene.model(device);
    const int hand = scene.track.find("LHand"), foot = scene.track.find("RFoot");
    // At most 0.2 s are interpolated: six frames; what is longer is missing.
    scene.track.confidence.col(hand).segment(10, 6).setZero();
    scene.track.x_px.col(foot).segment(20, 7).setConstant(std::numeric_limits<double>::quiet_NaN());
    TrackFindings found;
    const auto got = regenerate_clip(model, scene.track, scene.placement(), {}, &found);
    CHECK(found.filled.interpolated == 6);
    CHECK(found.filled.missing == 7);
    const auto want = step_by_step(model, scene.track, scene.placement(), {});
    CHECK(largest(got[0].channels - want[0].channels) < 1e-9);
    Track2d lost = scene.track;
    lost.joint_names[static_cast<std::size_t>(hand)] = "Tail";
    regenerate_clip(model, lost, scene.placement(), {}, &found);
    CHECK(found.filled.unseen == std::vector<std::string>{"LHand"});
    CHECK(found.swaps.empty());
    for (std::string& name : lost.joint_names) name.replace(0, name.size(), name.size() + 1, 'x');
    CHECK_THROWS_AS(regenerate_clip(model, lost, scene.placement(), {}), InputError);
  });
}

TEST_CASE("regenerate_clip: missing joints are counted in frames of the track") {
  on_every_device([](Device& device) {
    Scene scene(60.0, 100);
    const Model model = scene.model(device);
    scene.track.confidence.col(scene.track.find("RFoot")).segment(20, 24).setZero();
    TrackFindings found;
    regenerate_clip(model, scene.track, scene.placement(), {}, &found);
    // The model sees 12 such frames at its 30 a second, one more or less at the ends.
    CHECK(std::abs(found.filled.missing - 24) <= 2);
    CHECK(found.filled.interpolated == 0);
  });
}

TEST_CASE("regenerate_clip: a pose that does not match what the camera shows is placed by size") {
  Scene scene(30.0);
  const Modalities& m = scene.modalities;
  const MatrixF truth = m.encode_pose(scene.clip, scene.camera.camera_from_world);
  const PoseAnswer single = [&](const MatrixF&) { return PosePrior(truth); };
  const PoseAnswers all = [&](const MatrixF&) { return std::vector<PosePrior>{truth}; };
  TrackFindings found;
  const auto root_of = [&](const Track2d& track) {
    const auto motions = regenerate_clip(m, track, scene.placement(), single, all, &found);
    return path_of(motions.at(0), "Hips");
  };
  const MatrixD wanted = root_of(scene.track);
  CHECK_FALSE(found.placed_by_size);
  // The film upside down, the answer as before.
  Track2d turned = scene.track;
  turned.x_px = 2 * scene.camera.cx_px - scene.track.x_px.array();
  turned.y_px = 2 * scene.camera.cy_px - scene.track.y_px.array();
  const MatrixD root = root_of(turned);
  CHECK(found.placed_by_size);
  // Seen as large as before, the person is about as far away.
  const auto depth = [&](const MatrixD& path) {
    return ((path * scene.camera.camera_from_world.transpose()).col(2).array() +
            scene.camera.translation.z())
        .eval();
  };
  CHECK(largest(depth(root).matrix() - depth(wanted).matrix()) < body_height(scene.clip.skeleton));
}

TEST_CASE("regenerate_clip: the camera that the first answer finds sees the others, too") {
  Scene scene(30.0);
  scene.modalities.level_view = true;  // the camera's angles and focal length are unknown, too
  const Modalities& m = scene.modalities;
  const MatrixF truth = m.encode_pose(scene.clip, scene.camera.camera_from_world);
  const PoseAnswer single = [&](const MatrixF&) { return PosePrior(truth); };
  for (const bool fitted : {false, true}) {
    CAPTURE(fitted);
    ClipPlacement placement;
    if (!fitted) placement.fit.reset();
    TrackFindings found;
    const auto got = regenerate_clip(m, scene.track, placement, single, several(single, 2), &found);
    REQUIRE(got.size() == 2);
    if (fitted) CHECK(std::abs(pitch_deg(found.camera) - scene.view.elevation_deg) < 3);
    // As if it were the only one, and that camera were known.
    placement.camera = found.camera;
    const PoseAnswers second = [&](const MatrixF& features) {
      return std::vector{several(single, 2)(features).back()};
    };
    const auto alone = regenerate_clip(m, scene.track, placement, single, second).front();
    CHECK(got[1].channels == alone.channels);
    CHECK(got[1].channels != got[0].channels);
    for (std::size_t joint = 0; joint < alone.skeleton.joints.size(); ++joint)
      CHECK(got[1].skeleton.joints[joint].offset == alone.skeleton.joints[joint].offset);
  }
}

TEST_CASE("regenerate_clip: how sure the network is of its answer comes with it") {
  on_every_device([](Device& device) {
    const Scene scene(30.0);
    Model model = scene.model(device);
    Mcdbn& network = model.network;
    const auto features = static_cast<std::size_t>(scene.modalities.pose_scale.output_dimension());
    network.deviation = {random_matrix(network.modality(kPose).visible, features, 5, 0.3F),
                         MatrixF::Constant(1, static_cast<Eigen::Index>(features), -1.2F)};
    ClipPlacement placement = scene.placement();
    placement.uncertainty_draws = {20, 3};
    TrackFindings found, without;
    regenerate_clip(model, scene.track, placement, {}, &found);
    const MatrixF seen = scene.modalities.encode_track(smooth_track(scene.track), scene.camera);
    const CodedAnswer answer = coded_answers(network, {seen}).front();
    const FittedClip want =
        fit_to_track({answer.mean, network.deviation->of(answer.code)}, scene.modalities,
                     scene.track, placement, std::nullopt, placement.uncertainty_draws);
    const MatrixD uncertainty = joint_uncertainty(want.motion, want.draws);
    CHECK(largest(found.uncertainty - uncertainty) < 1e-9 * largest(uncertainty));
    network.deviation.reset();
    regenerate_clip(model, scene.track, placement, {}, &without);
    CHECK(largest(found.uncertainty - without.uncertainty) > 0.1 * largest(uncertainty));
  });
}

TEST_CASE("gaps are filled in two rounds, each from the answer to the round before") {
  Scene scene(30.0);
  scene.track.confidence.col(scene.track.find("LHand")).segment(10, 20).setZero();
  const Modalities& m = scene.modalities;
  const MatrixF features = m.encode_track(scene.track, scene.camera);
  const MatrixF truth = m.encode_pose(scene.clip, scene.camera.camera_from_world);
  std::vector<MatrixF> asked;
  // Each answer holds the arm elsewhere, so that every round shows.
  const auto answer = [&](const MatrixF& seen) -> MatrixF {
    asked.push_back(seen);
    return truth * (1.0F - 0.1F * static_cast<float>(asked.size()));
  };
  const MatrixF filled = fill_gaps(m, features, scene.track, scene.placement(), answer);
  REQUIRE(asked.size() == 2);
  CHECK(asked[0].array().isNaN().any());
  for (const MatrixF& seen : {asked[1], filled}) CHECK_FALSE(seen.array().isNaN().any());
  CHECK(filled != asked[1]);
}

TEST_CASE("regenerate_clip: a level model answers alike to whatever tilt the camera has") {
  on_every_device([](Device& device) {
    Scene scene(30.0);
    scene.modalities.level_view = true;
    const Model model = scene.model(device);
    scene.track = project_motion(scene.clip, scene.camera);
    const auto joints = [&](const Model& of, const Track2d& track, const Camera& camera) {
      ClipPlacement placement = scene.placement();
      placement.camera = camera;
      const Motion motion = regenerate_clip(of, track, placement, {}).at(0);
      return joints_about(motion, {"LHand", "RHand", "LFoot", "RFoot"}, "Hips");
    };
    const MatrixD wanted = joints(model, scene.track, scene.camera);
    Camera tilted = scene.camera;
    const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    tilted.camera_from_world = tilt * tilted.camera_from_world;
    // The same network at the same place sees the same, so it answers the same in the world.
    const Eigen::Matrix3d heading = level_rotation(tilted.camera_from_world);
    tilted.camera_from_world = tilted.camera_from_world * heading.transpose() *
                               level_rotation(scene.camera.camera_from_world);
    const Eigen::Vector3d place =
        -scene.camera.camera_from_world.transpose() * scene.camera.translation;
    tilted.translation = -tilted.camera_from_world * place;
    const Track2d turned = turn_track(scene.track, scene.camera, tilted);
    REQUIRE(turned.confidence == scene.track.confidence);
    CHECK(largest(turned.x_px - scene.track.x_px) > 50);
    const double height = body_height(scene.clip.skeleton);
    CHECK(largest(joints(model, turned, tilted) - wanted) < 0.01 * height);
    Model old = scene.model(device);
    old.modalities.level_view = false;
    CHECK(largest(joints(old, turned, tilted) - wanted) > 0.1 * height);
  });
}

}  // namespace regenerate_clip_test
