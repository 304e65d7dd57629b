#pragma once

#include <Eigen/Geometry>

#include "features/clip_modalities.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

namespace mcdbn::test {

/// A walk before a camera that looks down and is turned, and the answer of a network that has
/// learnt upright walks, and not how this camera stands.
struct CameraScene {
  CameraPlacement view{60, 0, std::nullopt, 40, 1920, 1080};
  Motion truth;
  Modalities modalities;
  Camera camera;
  Track2d track;
  MatrixF pose;

  CameraScene(double pitch_deg, double roll_deg, SynthesisAction action = SynthesisAction::walk,
              double seconds = 4)
      : CameraScene(synthesize({.action = action, .seconds = seconds}), pitch_deg, roll_deg) {}

  CameraScene(const Motion& motion, double pitch_deg, double roll_deg)
      : truth(motion), modalities(modalities_of({truth}, view)) {
    modalities.level_view = true;
    CameraPlacement placement = view;
    placement.elevation_deg = pitch_deg;
    camera = place_camera(truth, placement);
    const Eigen::Matrix3d roll =
        Eigen::AngleAxisd(-roll_deg * EIGEN_PI / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    camera.camera_from_world = roll * camera.camera_from_world;
    camera.translation = roll * camera.translation;
    track = project_motion(truth, camera);
    pose = modalities.encode_pose(truth, camera.camera_from_world);
  }

  /// The answer of a network that takes the person for so much further above the ground.
  void raise_prior(double by_cm) {
    Motion raised = truth;
    raised.channels.col(1).array() += by_cm;
    pose = modalities.encode_pose(raised, camera.camera_from_world);
  }

  /// How high ankles are on average in frames where the true ones stand, over how high those are.
  double ankles_above_truth_cm(const Motion& motion) const {
    const MatrixD positions = joint_positions(motion), real = joint_positions(truth);
    double sum = 0;
    int count = 0;
    for (const char* name : {"LeftFoot", "RightFoot"}) {
      const Eigen::Index y = 3 * truth.skeleton.find(name) + 1;
      for (Eigen::Index t = 0; t < motion.frames(); ++t) {
        if (real(t, y) > real.col(y).minCoeff() + 1) continue;
        sum += positions(t, y) - real(t, y);
        ++count;
      }
    }
    return sum / count;
  }

  FittedClip fit(const AssumedView& given, const TrackFitSettings& settings = {}) const {
    return fit_to_track(pose, modalities, track, {std::nullopt, truth.skeleton, given}, settings);
  }
};

}  // namespace mcdbn::test
