#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "camera/occlusion.hpp"
#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// What a detector makes of the joints that it looks for. Lengths are shares of the body's height,
/// deviations are those of each axis of the image; speeds are body heights a second. Where the
/// figures of the named detectors come from: docs/detectors.md.
struct DetectorNoise {
  double bias = 0.006, bias_s = 5;
  double drift = 0.0055, drift_s = 0.25, drift_speed = 0.7;
  double jitter = 0.0008, jitter_speed = 0.002;
  double hidden = 0.018;
  double stray = 0.001, stray_hands = 0.0175, stray_hidden = 0.12, stray_size = 0.24,
         stray_s = 0.04;
  double lost = 0.001, lost_hidden = 0.25, lost_s = 0.09;
  double swapped_legs = 0.02, swapped_arms = 0.002, swap_s = 0.05;
  double confidence = 0.7, confidence_spread = 0.08, confidence_hidden = 0.45,
         confidence_stray = 0.25;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"bias", within(0, 100), "", "deviation of the part that stays for seconds"},
          self.bias);
    visit(Setting{"bias-time", above(0), "seconds", "how long it stays"}, self.bias_s);
    visit(Setting{"drift", within(0, 100), "", "deviation of the part that comes and goes"},
          self.drift);
    visit(Setting{"drift-time", above(0), "seconds", "how long that takes"}, self.drift_s);
    visit(Setting{"drift-speed", within(0, 100), "", "share by which speed 1 adds to it"},
          self.drift_speed);
    visit(Setting{"jitter", within(0, 100), "", "deviation of what is new in every frame, at rest"},
          self.jitter);
    visit(Setting{"jitter-speed", within(0, 100), "", "what speed 1 adds to it"},
          self.jitter_speed);
    visit(Setting{"hidden", within(0, 100), "",
                  "additional deviation of a hidden joint; it comes and goes as drift"},
          self.hidden);
    visit(
        Setting{"stray", share_below_one(), "", "share of the frames in which a joint is far off"},
        self.stray);
    visit(Setting{"stray-hands", share_below_one(), "", "as stray, of wrists and hands"},
          self.stray_hands);
    visit(Setting{"stray-hidden", share_below_one(), "", "as stray, of hidden joints"},
          self.stray_hidden);
    visit(Setting{"stray-size", above(0, 100), "", "how far, in the middle"}, self.stray_size);
    visit(Setting{"stray-time", above(0), "seconds", "how long, on average"}, self.stray_s);
    visit(Setting{"lost", share_below_one(), "", "share of the frames in which a joint is missing"},
          self.lost);
    visit(Setting{"lost-hidden", share_below_one(), "", "as lost, of hidden joints"},
          self.lost_hidden);
    visit(Setting{"lost-time", above(0), "seconds", "how long, on average"}, self.lost_s);
    visit(Setting{"swapped-legs", share_below_one(), "",
                  "share of the frames with the legs close to each other in which left is right"},
          self.swapped_legs);
    visit(Setting{"swapped-arms", share_below_one(), "", "as swapped-legs, of arms"},
          self.swapped_arms);
    visit(Setting{"swap-time", above(0), "seconds", "how long, on average"}, self.swap_s);
    visit(Setting{"confidence", within(0, 1), "", "mean, of a visible joint"}, self.confidence);
    visit(Setting{"confidence-spread", within(0, 100), "", "its deviation; twice it if hidden"},
          self.confidence_spread);
    visit(Setting{"confidence-hidden", within(0, 1), "", "mean, of a hidden joint"},
          self.confidence_hidden);
    visit(Setting{"confidence-stray", within(0, 1), "", "mean, of a joint that is far off"},
          self.confidence_stray);
  }
};

/// A detector by its name, what it does and which joints it sees.
struct Detector {
  std::string_view name;       ///< "openpose"
  std::string_view joint_set;  ///< "BODY_25"
  DetectorNoise noise;
};

/// openpose, mediapipe, coco (RTMPose's noise on COCO's 17 joints).
const std::vector<Detector>& detectors();

/// The noise of the detector that made a track, as far as the track itself shows it. All noise of
/// visible joints is estimated from the jitter, in OpenPose's proportions; the share of lost joints
/// from the gaps of those that any frame shows, in frames that show anybody; confidences from the
/// track's. What a track without ground truth does not show is OpenPose's.
/// @param height_px of the person  @throws InputError with fewer than 10 frames
DetectorNoise measured_noise(const Track2d& track, double height_px);

/// What the columns of a detector's track show. One that no frame shows keeps its name, and nothing
/// is known of it: a detector like that one never sees it.
std::vector<Keypoint> seen_keypoints(const Track2d& track);

/// The height in pixels of the person whom a detector's track shows, by thighs and shanks where
/// they look longest. NaN without those joints.
double person_height_px(const Track2d& track);

/// Turns exact places of keypoints into a detector's. A seed always gives the same noise, which in
/// one column does not depend on other columns, but for swaps, which exchange limbs of all roles at
/// once.
/// @param track exact, with keypoints  @param hidden [frames x joints] hidden from the camera
/// @param height_px [frames] of the body in the image
/// @throws ShapeError if they do not fit; ConfigError if a setting is out of range
void detect(Track2d& track, const Flags& hidden, const Eigen::VectorXd& height_px,
            const DetectorNoise& noise, std::uint64_t seed);

}  // namespace mcdbn
