// The room features: motion and tracks as the numbers that machines learn, and back.
// It uses camera.
// Add here: a modality: encode, decode, and its scaling in Modalities.
#pragma once

#include "mcdbn/camera/assumed_view.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/features/pose_features.hpp"
#include "mcdbn/features/standardizer.hpp"
#include "mcdbn/features/track_features.hpp"

namespace mcdbn {

/// How motion and 2D tracks become the network's standardized rows and back (docs/concepts.md).
struct Modalities {
  static constexpr Range kDirections = within(1, 36);

  PoseFeatures pose_features;
  TrackFeatures track_features;
  Standardizer pose_scale, track_scale;
  double fps = 30.0;
  CameraPlacement camera;  ///< the view that the training tracks were projected through
  /// From how many directions clips as they are were seen (placements_around `camera`): motion that
  /// the network generates may be turned as many ways.
  std::size_t directions = 1;
  /// Whether the network sees and answers in the camera's level view (level_camera, with `camera`'s
  /// field of view), so that its axes are gravity and the camera's heading; else in the camera's
  /// own, as models did before there was one.
  bool level_view = false;

  const std::string& root_name() const {
    return pose_features.skeleton().joints[static_cast<std::size_t>(pose_features.root())].name;
  }
  /// The axes of the 3D features of what that camera sees. @return features_from_world
  Eigen::Matrix3d pose_axes(const Eigen::Matrix3d& camera_from_world) const;
  /// 3D features before scaling. @return [frames x pose_features.dimension()]
  MatrixD pose_values(const Motion& clip, const Eigen::Matrix3d& camera_from_world) const;
  /// @return [frames x pose_scale.output_dimension()]
  MatrixF encode_pose(const Motion& clip, const Eigen::Matrix3d& camera_from_world) const;
  /// Inverse of encode_pose()'s scaling: 3D features along the camera's own axes.
  /// @return [frames x pose_features.dimension()]
  MatrixD pose_in_camera(const MatrixF& standardized,
                         const Eigen::Matrix3d& camera_from_world) const;

  /// 2D features before scaling. @param track as the camera saw it
  /// @param filled if given, what the track lacks, and what the level view does not show of it
  /// @return [frames x track_features.dimension()], NaN where joints are missing for long
  MatrixD track_values(const Track2d& track, const Camera& seen_by,
                       TrackFeatures::FillCount* filled = nullptr) const;
  /// @return [frames x track_scale.output_dimension()], NaN likewise
  MatrixF encode_track(const Track2d& track, const Camera& seen_by,
                       TrackFeatures::FillCount* filled = nullptr) const;
  /// The inverse of encode_track: pixels of that camera's image.
  Track2d decode_track(const MatrixF& standardized, const Camera& seen_by) const;

  /// A camera at the world's origin, for a track of which no more is known. What the view does not
  /// give is assumed: no pitch, no roll and usual_field_of_view_deg; without a level view the
  /// elevation and field of view of the model's own camera. Its heading is always that one's.
  /// @throws ConfigError if the view is not a camera's
  Camera assumed_camera(const AssumedView& view, int width_px, int height_px) const;
};

}  // namespace mcdbn
