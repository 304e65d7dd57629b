// What a growing track's noise, confidences and rate count for, and how sure the network is.

#include <doctest/doctest.h>

#include <cmath>

#include "camera/keypoint_track.hpp"
#include "camera/track_noise.hpp"
#include "device/every_device.hpp"
#include "mcdbn/motion_model/live_regeneration.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion_model/live_scene.hpp"

namespace live_evidence_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

Motion live_motion(const Model& model, const Track2d& track, const ClipPlacement& placement) {
  LiveRegeneration live(model, track, placement);
  return followed(live, track);
}

/// How far joints jerk, without the first frames, in which the fit begins.
double roughness_mm(const Motion& motion) {
  const MatrixD places = places_mm(motion).bottomRows(motion.frames() - 5);
  const Eigen::Index inner = places.rows() - 2;
  return (places.bottomRows(inner) - 2 * places.middleRows(1, inner) + places.topRows(inner))
      .norm();
}

/// The same deviation of all features, standardized.
AnswerDeviation deviation_of(const Mcdbn& network, const Modalities& modalities, double deviation) {
  const Eigen::Index features = modalities.pose_scale.output_dimension();
  const auto code = static_cast<Eigen::Index>(network.modality(kPose).visible);
  return {MatrixF::Zero(code, features),
          MatrixF::Constant(1, features, static_cast<float>(std::log(deviation)))};
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

double pitch_deg(const Camera& camera) {
  return std::asin(-camera.camera_from_world.col(1).z()) * 180 / EIGEN_PI;
}

}  // namespace

TEST_CASE("live: the surer the network is, the less its answer gives way to the track") {
  on_every_device([](Device& device) {
    const LiveScene scene;
    ClipPlacement placement = scene.placement();
    placement.fit->orientation_deviation_deg = 0.1;  // the least
    Model model = scene.model(device);
    const auto live_with = [&](double deviation) {
      model.network.deviation = deviation_of(model.network, scene.modalities, deviation);
      return live_motion(model, scene.track, placement);
    };
    const Motion unsure = live_with(3), sure = live_with(1e-3);
    CHECK(apart_mm(unsure, sure) > 20);
    CHECK(apart_mm(unsure, scene.clip) < 0.7 * apart_mm(sure, scene.clip));
  });
}

TEST_CASE("live: a track's noise does not pass into the motion") {
  on_every_device([](Device& device) {
    LiveScene scene;
    add_pixel_noise(scene.track, 6, 1);
    const Model model = scene.model(device);
    ClipPlacement placement = scene.placement();
    placement.fit->detector_noise_heights = 1e-4;  // what the track shows is all
    const auto rougher_than_whole = [&] {
      return roughness_mm(live_motion(model, scene.track, placement)) /
             roughness_mm(regenerate_clip(model, scene.track, placement, {}).front());
    };
    CHECK(rougher_than_whole() < 1.6);
    placement.fit->orientation_deviation_deg = 0.1;  // the network's answer as it is
    CHECK(rougher_than_whole() < 4);
  });
}

TEST_CASE("live, and the whole clip: how sure a detector is counts by its own usual") {
  on_every_device([](Device& device) {
    LiveScene scene(30, 30);
    const Model model = scene.model(device);
    scene.track = keypoint_track(scene.clip, scene.camera, coco_keypoints());
    const auto answers = [&] {
      return std::vector{live_motion(model, scene.track, scene.placement()),
                         regenerate_clip(model, scene.track, scene.placement(), {}).front()};
    };
    const auto wanted = answers();
    scene.track.confidence *= 0.5;
    const auto got = answers();
    for (std::size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i);
      CHECK(largest(got[i].channels - wanted[i].channels) == 0);
    }
    scene.track.confidence.col(scene.track.find("left_wrist")) *= 0.5;
    const auto other = answers();
    for (std::size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i);
      CHECK(largest(other[i].channels - wanted[i].channels) > 1e-3);
    }
  });
}

TEST_CASE("live: twice as many frames a second are as near to the whole clip's answer") {
  on_every_device([](Device& device) {
    const LiveScene scene(60, 100);
    const Model model = scene.model(device);
    const Motion whole = regenerate_clip(model, scene.track, scene.placement(), {}).front();
    CHECK(apart_mm(live_motion(model, scene.track, scene.placement()), whole) < 15);
  });
}

TEST_CASE("live: a detector's noisy keypoints at 60 Hz, unknown camera, learnt deviations") {
  on_every_device([](Device& device) {
    LiveScene scene(60, 100);
    scene.modalities.level_view = true;
    Model model = scene.model(device);
    model.network.deviation = deviation_of(model.network, scene.modalities, 1);
    scene.track = keypoint_track(scene.clip, scene.camera, coco_keypoints());
    add_pixel_noise(scene.track, 3, 1);
    for (Eigen::Index t = 0; t < scene.track.frames(); ++t)
      for (Eigen::Index j = 0; j < scene.track.joint_count(); ++j)
        scene.track.confidence(t, j) = 0.4 + 0.05 * static_cast<double>((3 * t + 7 * j) % 9);
    ClipPlacement placement = scene.placement();
    placement.camera.reset();
    placement.view.field_of_view_deg = 45;
    TrackFindings found;
    const Motion whole = regenerate_clip(model, scene.track, placement, {}, &found).front();
    LiveRegeneration live(model, scene.track, placement);
    CHECK(apart_mm(followed(live, scene.track), whole) < 25);
    CHECK(pitch_deg(live.camera()) > 4);  // of 12, which the mean pose leaves open
    CHECK(std::abs(pitch_deg(live.camera()) - pitch_deg(found.camera)) < 3);
  });
}

}  // namespace live_evidence_test
