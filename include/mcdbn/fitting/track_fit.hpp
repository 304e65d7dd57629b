// The room fitting: poses that are likely beforehand meet the 2D track that shows them. It uses
// features. Its door is fit_to_track; behind it: root paths, the fit of joints, smoothing. Add
// here: a cost of the fit.
#pragma once

#include <optional>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/features/modalities.hpp"

namespace mcdbn {

/// What is likely of each pose of a clip before its track is looked at: a normal distribution for
/// each frame and feature. It is all that the fit knows of a network. Standardized 3D features,
/// [frames x Modalities::pose_scale.output_dimension()] both.
struct PosePrior {
  MatrixF mean;
  /// Standard deviation, finite and not negative; below 1e-6 counts as that. The fit takes the RMS
  /// over an orientation's features for how far TrackFitSettings::turn_deg may turn it, and over
  /// all velocities of the clip for how far the root's velocity may be off. Height and the root's
  /// position are not asked.
  MatrixF deviation;

  /// With deviation 1, the spread of the training clips: for a mean that says nothing of how sure
  /// it is. The fit then has the same deviations for every frame and joint: those of its settings.
  static PosePrior around(MatrixF mean);
};

/// What is known of a clip besides its track.
struct KnownOfClip {
  std::optional<Camera> camera;  ///< unset: the assumed one, the clip put at the origin
  /// The person's own; unset: the model's, and the fit allows for other proportions.
  std::optional<Skeleton> skeleton;
  AssumedView view = {};  ///< what is known of the camera that is assumed

  /// The camera, or the one that is assumed for that track.
  Camera camera_of(const Track2d& track, const Modalities& modalities) const {
    return camera ? *camera : modalities.assumed_camera(view, track.width_px, track.height_px);
  }
};

/// How far poses may be bent to meet the track. The defaults were chosen on the CMU walkers 02, 32,
/// 35 and 39, held out of training, over clean, noisy and incomplete tracks together; footing_m
/// also on Bandai's walks.
struct TrackFitSettings {
  double turn_deg = 25;
  double change = 0.4;
  double likeness = 0.5;
  double position_m = 0.1;
  double footing_m = 0.0125;
  double caution = 2;
  double proportions_m = 0;
  double bend_m_s2 = 0.7;
  double fade_s = 0.1;

  /// Metres are those of a 1.7 m body.
  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(
        Setting{
            "turn", above(0), "degrees",
            "standard deviation of an orientation about each axis where PosePrior::deviation is 1"},
        self.turn_deg);
    visit(Setting{"change", above(0), "",
                  "deviation of a turn from those of the frames around it, as a share of its own"},
          self.change);
    // At 1 a joint would turn with its parent and no other way.
    visit(Setting{"likeness", share_below_one(), "",
                  "correlation of a joint's turn with its parent's"},
          self.likeness);
    visit(Setting{"position", above(0), "m", "standard deviation of the root's position"},
          self.position_m);
    visit(Setting{"footing", above(0), "m",
                  "how far a foot that stands still on the image strays from the depth that it has "
                  "in the frames around"},
          self.footing_m);
    visit(Setting{"caution", above(0), "",
                  "how many times the track's noise it is taken to be off by"},
          self.caution);
    visit(Setting{"proportions", at_least(0), "m",
                  "how far, at least, joints are from where a body of the skeleton's proportions "
                  "has them: for a skeleton that is not the person's own"},
          self.proportions_m);
    visit(Setting{"bend", above(0), "m/s2",
                  "how fast the answer's error changes (RMS of its acceleration): with the track's "
                  "noise it says over how many frames to smooth"},
          self.bend_m_s2);
    visit(Setting{"fade", above(0), "seconds",
                  "how long a joint's correction outlives the joint's last observation"},
          self.fade_s);
  }
};

/// A motion that meets its track.
struct FittedClip {
  Motion motion;  ///< at the model's rate
  Track2d shown;  ///< all its joints as the camera sees them; image size as the track's
  Camera camera;  ///< that sees `motion` so, in the skeleton's file units
};

/// The likeliest motion given a prior and the 2D track. The root goes where the track shows it;
/// with settings, orientations are turned so that joints lie where the track shows them, and feet
/// that stand say how fast the root travels. Without a camera only the path's shape is known: it
/// starts above the origin, at the height that the features say.
/// @param features what decodes features to poses, and the joints to look at
/// @param track at the model's rate, as many frames as the prior; joined by name
/// @param settings unset: orientations stay as the prior's mean has them
/// @throws ShapeError; InputError if the skeleton lacks a joint of the model, no frame shows enough
///         joints, or a deviation is negative or not finite
FittedClip fit_to_track(const PosePrior& prior, const Modalities& features, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings);

}  // namespace mcdbn
