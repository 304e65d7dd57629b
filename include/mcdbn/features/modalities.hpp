// The room features: motion and tracks as the numbers that machines learn, and back.
// It uses camera.
// Add here: a modality: encode, decode, and its scaling in Modalities.
#pragma once

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/features/pose_features.hpp"
#include "mcdbn/features/standardizer.hpp"
#include "mcdbn/features/track_features.hpp"

namespace mcdbn {

/// How motion and 2D tracks become the network's standardized rows and back (docs/concepts.md).
struct Modalities {
  PoseFeatures pose_features;
  TrackFeatures track_features;
  Standardizer pose_scale, track_scale;
  double fps = 30.0;
  CameraPlacement camera;  ///< the view that the training tracks were projected through

  const std::string& root_name() const {
    return pose_features.skeleton().joints[static_cast<std::size_t>(pose_features.root())].name;
  }
  /// @return [frames x pose_scale.output_dimension()]
  MatrixF encode_pose(const Motion& clip, const Eigen::Matrix3d& camera_from_world) const {
    return pose_scale.apply(pose_features.encode(clip, camera_from_world));
  }
  /// @return [frames x track_scale.output_dimension()], NaN where joints are missing for long
  MatrixF encode_track(const Track2d& track, TrackFeatures::FillCount* filled = nullptr) const {
    return track_scale.apply(track_features.encode(track, filled));
  }
  /// The inverse of encode_track, on an image of that size.
  Track2d decode_track(const MatrixF& standardized, int width_px, int height_px) const {
    return track_features.decode(track_scale.invert(standardized), fps, width_px, height_px);
  }
};

}  // namespace mcdbn
