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

  FittedClip fit(const AssumedView& given, const TrackFitSettings& settings = {}) const {
    return fit_to_track(pose, modalities, track, {std::nullopt, truth.skeleton, given}, settings);
  }
};

}  // namespace mcdbn::test
