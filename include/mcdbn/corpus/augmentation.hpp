#pragma once

#include <cstddef>

#include "mcdbn/base/random.hpp"
#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// How far a view of a clip may be from the clip as it was captured: other people, other cameras,
/// other ways to hold oneself. Deviations are of normal draws, one a view unless stated otherwise.
struct AugmentationSettings {
  std::size_t views = 20;
  bool mirror = true;
  double azimuth_deg = 0.0, elevation_deg = 0.0;
  double distance = 0.0;
  double bone = 0.05;
  double turn_deg = 2.0;
  double speed = 0.05;
  double noise_px = 0.5;
  double missing = 0.3;
  double detector = 0.0;
  double limbs_exchanged = 0.0, limbs_turned = 0.0, limbs_turned_deg = 25.0;
  double arms_anywhere = 0.0;
  double leaning = 0.0, leaning_deg = 15.0;
  double turning_round = 0.0;
  double gravity_deg = 0.0;

  /// Whether views hold poses that no clip holds, which takes the canonical humanoid.
  bool new_poses() const {
    return limbs_exchanged > 0 || limbs_turned > 0 || arms_anywhere > 0 || leaning > 0 ||
           turning_round > 0;
  }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"views", within(1, 1e5), "views",
                  "views of each clip; fewer if they would exceed about two hours in all"},
          self.views);
    visit(Setting{"mirror", on_or_off(), "",
                  "exchange left and right in half of the views, where the skeleton has sides"},
          self.mirror);
    visit(Setting{"azimuth", within(0, 180), "degrees",
                  "largest turn of the camera around the person, to either side: for tracks of "
                  "unknown cameras"},
          self.azimuth_deg);
    visit(Setting{"elevation", within(0, 90), "degrees",
                  "largest change of the camera's elevation, up or down"},
          self.elevation_deg);
    visit(Setting{"distance", within(0, 10), "",
                  "relative deviation of the camera's distance: for other perspectives"},
          self.distance);
    visit(Setting{"bone", within(0, 1), "",
                  "relative deviation of each bone's length, both sides alike: for other people"},
          self.bone);
    visit(
        Setting{"turn", within(0, 180), "degrees",
                "deviation of a turn that each joint keeps throughout a view: for other postures"},
        self.turn_deg);
    // The clip takes 1 / (1 ± speed) of its time.
    visit(
        Setting{"speed", within(0, 0.9), "", "largest relative change of speed, faster or slower"},
        self.speed);
    visit(Setting{"noise", within(0, 100), "px",
                  "mean deviation of noise on the 2D joints of a 700 px tall figure, less on a "
                  "smaller one; each view has from none to twice as much"},
          self.noise_px);
    visit(Setting{"missing", within(0, 1), "",
                  "share of the views in which limbs are hidden for a while"},
          self.missing);
    visit(Setting{"detector", within(0, 1), "",
                  "share of the views with the track of a detector (OpenPose, MediaPipe or "
                  "RTMPose, with measured errors), through a camera anywhere around the person"},
          self.detector);
    visit(Setting{"limbs-exchanged", within(0, 1), "",
                  "share of the views with the legs of one clip, the upper body of another and an "
                  "arm of a third: poses that no clip holds"},
          self.limbs_exchanged);
    visit(Setting{"limbs-turned", within(0, 1), "",
                  "share of the views in which limbs and trunk are turned smoothly at random, "
                  "within the limits of the clips' joints"},
          self.limbs_turned);
    visit(Setting{"limbs-turned-by", within(0, 180), "degrees",
                  "deviation of that turn about each axis"},
          self.limbs_turned_deg);
    visit(
        Setting{"arms-anywhere", within(0, 1), "",
                "share of the views in which arms point anywhere in front of and beside the body"},
        self.arms_anywhere);
    visit(Setting{"leaning", within(0, 1), "",
                  "share of the views in which all above the hips leans, in changing directions"},
          self.leaning);
    visit(Setting{"leaning-by", within(0, 180), "degrees", "deviation of that lean"},
          self.leaning_deg);
    visit(Setting{"turning-round", within(0, 1), "",
                  "share of the views in which the person turns around in the course of the clip"},
          self.turning_round);
    visit(Setting{"gravity", within(0, 180), "degrees",
                  "standard deviation of an error in the direction of gravity: for phones and "
                  "assumed cameras"},
          self.gravity_deg);
  }
};

class PosePool;

/// A view of a clip before scaling.
struct AugmentedView {
  Motion motion;  ///< at the model's rate
  Camera camera;
  Track2d track;
};

/// A changed view of the clip. A key always gives the same view. A detector's track, too, is of the
/// skeleton's own joints, as far as its keypoints show them.
/// @param raw at its own rate
/// @param hide_no_limb no limb is hidden; what a detector loses is missing all the same
/// @param pool what new poses are made of; none: there are no new poses
AugmentedView augmented_view(const Motion& raw, double fps, const CameraPlacement& placement,
                             const AugmentationSettings& settings, const RandomKey& key,
                             bool hide_no_limb = false, const PosePool* pool = nullptr);

}  // namespace mcdbn
