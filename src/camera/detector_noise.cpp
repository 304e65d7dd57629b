#include "camera/detector_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "camera/keypoint_pairs.hpp"
#include "camera/track_columns.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Normal numbers of deviation 1 with the correlation time `time_s` (first-order autoregression).
class Drift {
 public:
  Drift(double time_s, double fps, RandomSequence& random)
      : kept_(std::exp(-1.0 / (time_s * fps))), random_(random), now_(drawn()) {}
  Eigen::Vector2d next() {
    Eigen::Vector2d value = now_;
    now_ = kept_ * now_ + std::sqrt(1 - kept_ * kept_) * drawn();
    return value;
  }

 private:
  Eigen::Vector2d drawn() {
    const double x = random_.normal();
    return {x, random_.normal()};
  }
  double kept_;
  RandomSequence& random_;
  Eigen::Vector2d now_;
};

/// A state that holds for a while, again and again: at a constant share in that share of the
/// frames, each time for `time_s` on average.
class Episodes {
 public:
  Episodes(double time_s, double fps, RandomSequence& random)
      : ends_(1 - std::exp(-1.0 / (time_s * fps))), random_(random) {}
  /// Whether it holds in the next frame.
  bool next(double share) {
    const double draw = random_.uniform();
    const double ends = share > 0 ? std::min(ends_, (1 - share) / share) : 1.0;
    if (first_)
      on_ = draw < share;
    else
      on_ = on_ ? draw >= ends : draw < ends * share / (1 - share);
    began_ = on_ && (first_ || !was_on_);
    first_ = false;
    was_on_ = on_;
    return on_;
  }
  bool began() const { return began_; }

 private:
  double ends_;
  RandomSequence& random_;
  bool first_ = true, on_ = false, was_on_ = false, began_ = false;
};

bool is_hand(const Keypoint& keypoint) {
  using enum JointRole;
  return keypoint.role == left_wrist || keypoint.role == right_wrist ||
         keypoint.role == left_hand || keypoint.role == right_hand;
}

/// One column of a track, from frame to frame.
class ColumnNoise {
 public:
  ColumnNoise(const DetectorNoise& noise, const Keypoint& keypoint, double fps, std::uint64_t seed)
      : noise_(noise),
        stray_visible_(is_hand(keypoint) ? noise.stray_hands : noise.stray),
        random_(seed, random_streams::kDetector),
        bias_(noise.bias_s, fps, random_),
        drift_(noise.drift_s, fps, random_),
        hidden_(noise.drift_s, fps, random_),
        stray_(noise.stray_s, fps, random_),
        lost_(noise.lost_s, fps, random_) {}

  struct Seen {
    Eigen::Vector2d off = Eigen::Vector2d::Zero();  ///< shares of body height
    double confidence = 0;                          ///< 0: missing
  };

  /// @param speed body heights a second
  Seen next(double speed, bool hidden) {
    const Eigen::Vector2d drift = noise_.drift * (1 + noise_.drift_speed * speed) * drift_.next() +
                                  (hidden ? noise_.hidden : 0.0) * hidden_.next();
    const double x = random_.normal();
    const Eigen::Vector2d jitter =
        (noise_.jitter + noise_.jitter_speed * speed) * Eigen::Vector2d(x, random_.normal());
    const bool astray =
        stray_.next(hidden ? std::max(noise_.stray_hidden, stray_visible_) : stray_visible_);
    if (stray_.began()) stray_to_ = drawn_stray();
    const bool lost = lost_.next(hidden ? noise_.lost_hidden : noise_.lost);
    Seen seen{noise_.bias * bias_.next() + drift + jitter, drawn_confidence(hidden, astray)};
    if (astray) seen.off += stray_to_;
    if (lost) seen.confidence = 0;
    return seen;
  }

 private:
  Eigen::Vector2d drawn_stray() {
    constexpr double kSpread = 0.32;  // of the logarithm of the size, as measured
    const double size = noise_.stray_size * std::exp(kSpread * random_.normal());
    const double angle = random_.uniform(0, 2 * std::numbers::pi);
    return size * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }

  double drawn_confidence(bool hidden, bool astray) {
    constexpr double kLeast = 0.02;  // 0 would be missing
    const double mean = astray   ? noise_.confidence_stray
                        : hidden ? noise_.confidence_hidden
                                 : noise_.confidence;
    const double spread = (astray || hidden ? 2 : 1) * noise_.confidence_spread;
    return std::clamp(mean + spread * random_.normal(), kLeast, 1.0);
  }

  const DetectorNoise& noise_;
  double stray_visible_;
  RandomSequence random_;
  Drift bias_, drift_, hidden_;
  Episodes stray_, lost_;
  Eigen::Vector2d stray_to_ = Eigen::Vector2d::Zero();
};

/// Body heights a second, over the frames to both sides. @return [frames]
Eigen::VectorXd speed_of(const Track2d& track, Eigen::Index column,
                         const Eigen::VectorXd& height_px) {
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(track.frames());
  for (Eigen::Index frame = 0; frame < speed.size(); ++frame) {
    const Eigen::Index before = std::max<Eigen::Index>(frame - 1, 0),
                       after = std::min<Eigen::Index>(frame + 1, speed.size() - 1);
    if (before == after) continue;
    const double moved = (pixel_at(track, after, column) - pixel_at(track, before, column)).norm();
    const double now = moved * track.fps / static_cast<double>(after - before) / height_px[frame];
    if (std::isfinite(now)) speed[frame] = now;
  }
  return speed;
}

void add_noise(Track2d& track, Eigen::Index column, const Flags& hidden,
               const Eigen::VectorXd& height_px, const DetectorNoise& noise, std::uint64_t seed) {
  ColumnNoise own(noise, track.keypoints[static_cast<std::size_t>(column)], track.fps, seed);
  const Eigen::VectorXd speed = speed_of(track, column, height_px);
  for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
    const ColumnNoise::Seen seen = own.next(speed[frame], hidden(frame, column));
    if (track.confidence(frame, column) == 0) continue;
    track.x_px(frame, column) += height_px[frame] * seen.off.x();
    track.y_px(frame, column) += height_px[frame] * seen.off.y();
    track.confidence(frame, column) = seen.confidence;
    if (seen.confidence == 0) track.x_px(frame, column) = track.y_px(frame, column) = kNan;
  }
}

/// In which frames two like limbs are close to each other in the image.
std::vector<bool> close_frames(const Track2d& track, const LimbPairs& limbs,
                               const Eigen::VectorXd& height_px) {
  constexpr double kClose = 0.1;
  std::vector<bool> close(static_cast<std::size_t>(track.frames()), false);
  for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
    double sum = 0;
    for (const auto& [left, right] : limbs.distal)
      sum += (pixel_at(track, frame, left) - pixel_at(track, frame, right)).norm();
    const double mean = sum / static_cast<double>(limbs.distal.size());
    close[static_cast<std::size_t>(frame)] = mean < kClose * height_px[frame];
  }
  return close;
}

void swap_limbs(Track2d& track, const LimbPairs& limbs, const std::vector<bool>& close,
                double share, double time_s, std::uint64_t seed) {
  RandomSequence random(seed, random_streams::kDetectorSwaps);
  Episodes swapped(time_s, track.fps, random);
  for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
    if (!swapped.next(close[static_cast<std::size_t>(frame)] ? share : 0.0)) continue;
    for (const auto& [left, right] : limbs.columns) exchange_columns(track, frame, left, right);
  }
}

}  // namespace

const std::vector<Detector>& detectors() {
  static const std::vector<Detector> all = [] {
    DetectorNoise rtmpose;
    rtmpose.bias = 0.007;
    rtmpose.drift = 0.0072;
    rtmpose.drift_speed = 0.3;
    rtmpose.jitter = 0.0005;
    rtmpose.jitter_speed = 0.0028;
    rtmpose.stray = rtmpose.stray_hands = rtmpose.stray_hidden = 0;
    rtmpose.lost = rtmpose.lost_hidden = 0;
    rtmpose.confidence = 0.85;
    rtmpose.confidence_spread = 0.09;
    rtmpose.confidence_hidden = 0.73;
    DetectorNoise mediapipe;
    mediapipe.jitter = 0.0005;
    mediapipe.jitter_speed = 0.0012;
    mediapipe.stray = 0.02;
    mediapipe.stray_hands = 0.025;
    mediapipe.stray_size = 0.12;
    mediapipe.stray_s = 0.03;
    mediapipe.lost = mediapipe.lost_hidden = 0;
    mediapipe.swapped_legs = 0.1;
    mediapipe.swapped_arms = 0.01;
    mediapipe.confidence = 0.98;
    mediapipe.confidence_spread = 0.04;
    mediapipe.confidence_hidden = 0.5;
    mediapipe.confidence_stray = 0.7;
    return std::vector<Detector>{{"openpose", "BODY_25", {}},
                                 {"mediapipe", "MEDIAPIPE_33", mediapipe},
                                 {"coco", "COCO_17", rtmpose}};
  }();
  return all;
}

void detect(Track2d& track, const Flags& hidden, const Eigen::VectorXd& height_px,
            const DetectorNoise& noise, std::uint64_t seed) {
  check_settings(noise);
  const Eigen::Index joints = track.joint_count();
  if (static_cast<Eigen::Index>(track.keypoints.size()) != joints ||
      hidden.rows() != track.frames() || hidden.cols() != joints ||
      height_px.size() != track.frames())
    throw ShapeError(
        fmt::format("a track of {}x{} with {} keypoints; what is hidden is {}x{}, heights are {}",
                    track.frames(), joints, track.keypoints.size(), hidden.rows(), hidden.cols(),
                    height_px.size()));
  // Whether limbs are close is judged by their true places, not by the noisy ones.
  const std::array limbs{leg_pairs(track.keypoints), arm_pairs(track.keypoints)};
  const std::array shares{noise.swapped_legs, noise.swapped_arms};
  std::array<std::vector<bool>, 2> close;
  for (std::size_t i = 0; i < limbs.size(); ++i)
    if (!limbs[i].distal.empty()) close[i] = close_frames(track, limbs[i], height_px);
  for (Eigen::Index column = 0; column < joints; ++column)
    add_noise(track, column, hidden, height_px, noise,
              mixed_seed({seed, static_cast<std::uint64_t>(column)}));
  for (std::size_t i = 0; i < limbs.size(); ++i)
    if (!close[i].empty())
      swap_limbs(track, limbs[i], close[i], shares[i], noise.swap_s, mixed_seed({seed, i}));
}

}  // namespace mcdbn
