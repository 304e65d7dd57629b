#pragma once

#include <optional>

#include "mcdbn/camera/assumed_view.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// What is known of a clip besides its track.
struct KnownOfClip {
  std::optional<Camera> camera;  ///< unset: the assumed one, the clip put at the origin
  /// The person's own; unset: the model's, and the fit allows for other proportions.
  std::optional<Skeleton> skeleton;
  AssumedView view = {};   ///< what is known of the camera that is assumed
  AssumedView found = {};  ///< what was estimated of that camera; `view` takes precedence
  /// Whether the joints are a detector's keypoints: they are taken for no better than usual.
  bool detected = false;
  /// Whether the skeleton is not given but was found, in another part of the clip: the fit keeps
  /// it, and draws allow for other proportions.
  bool skeleton_found = false;

  bool body_given() const { return skeleton.has_value() && !skeleton_found; }
  /// Whether the track can be an exact projection: of a known body, and no detector's.
  bool may_be_exact() const { return skeleton.has_value() && !detected; }

  /// The camera, or the one that is assumed for that track.
  Camera camera_of(const Track2d& track, const Modalities& modalities) const {
    return camera ? *camera : modalities.assumed_camera(assumed(), track.width_px, track.height_px);
  }
  /// `view`, and `found` where `view` has nothing.
  AssumedView assumed() const {
    AssumedView all = view;
    if (!all.pitch_deg) all.pitch_deg = found.pitch_deg;
    if (!all.roll_deg) all.roll_deg = found.roll_deg;
    if (!all.field_of_view_deg) all.field_of_view_deg = found.field_of_view_deg;
    return all;
  }
};

}  // namespace mcdbn
