#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/counted.hpp"
#include "camera/detector_noise.hpp"
#include "camera/track_columns.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// @param share of the values that are smaller  @return NaN of none
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

int column_of(const Track2d& track, JointRole role) {
  for (std::size_t i = 0; i < track.keypoints.size(); ++i)
    if (track.keypoints[i].role == role && track.keypoints[i].offset.isZero())
      return static_cast<int>(i);
  return -1;
}

/// The deviation per axis of a fourth difference, of which movement leaves nothing, if each frame
/// had new noise of that deviation.
double fourth_difference(const Track2d& track, Eigen::Index frame, Eigen::Index column) {
  constexpr double kSquares = 1 + 16 + 36 + 16 + 1;
  const Eigen::Vector2d difference =
      pixel_at(track, frame - 2, column) - 4 * pixel_at(track, frame - 1, column) +
      6 * pixel_at(track, frame, column) - 4 * pixel_at(track, frame + 1, column) +
      pixel_at(track, frame + 2, column);
  return difference.norm() / std::sqrt(2 * kSquares);
}

/// The expected fourth_difference() of a detector with those settings at that speed.
double expected_difference(const DetectorNoise& noise, double fps, double speed) {
  const double r = std::exp(-1.0 / (noise.drift_s * fps));
  const double of_drift = (70 - 112 * r + 56 * r * r - 16 * r * r * r + 2 * r * r * r * r) / 70;
  const double drift = noise.drift * (1 + noise.drift_speed * speed),
               jitter = noise.jitter + noise.jitter_speed * speed;
  return std::sqrt(jitter * jitter + of_drift * drift * drift);
}

/// The ratio of the track's noise to a detector's for visible joints: the median over all
/// joint-frames. NaN where no joint is seen in five frames in a row.
double noise_ratio(const Track2d& track, double height_px, const DetectorNoise& usual) {
  constexpr double kMedianLength = 1.1774;  // of normal numbers in two dimensions
  std::vector<double> ratios;
  for (Eigen::Index column = 0; column < track.joint_count(); ++column) {
    for (Eigen::Index frame = 2; frame + 2 < track.frames(); ++frame) {
      const double difference = fourth_difference(track, frame, column) / height_px;
      if (!std::isfinite(difference)) continue;
      const double moved =
          (pixel_at(track, frame + 1, column) - pixel_at(track, frame - 1, column)).norm();
      const double speed = moved * track.fps / 2 / height_px;
      ratios.push_back(std::sqrt(2.0) * difference / kMedianLength /
                       expected_difference(usual, track.fps, speed));
    }
  }
  return quantile(std::move(ratios), 0.5);
}

struct Gaps {
  double share = 0, mean_frames = 1;
};

/// Gaps of the joints that the detector has, while it sees anybody.
Gaps gaps_of(const Track2d& track) {
  const auto shows_anybody = (track.confidence.array() > 0).rowwise().any().eval();
  double all = 0, missing = 0, gaps = 0;
  for (Eigen::Index column = 0; column < track.joint_count(); ++column) {
    const auto seen = (track.confidence.col(column).array() > 0).eval();
    if (!seen.any()) continue;
    bool was_lost = false;
    for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
      const bool is_lost = shows_anybody[frame] && !seen[frame];
      all += shows_anybody[frame];
      missing += is_lost;
      gaps += is_lost && !was_lost;
      was_lost = is_lost;
    }
  }
  if (gaps == 0) return {};
  return {missing / all, missing / gaps};
}

}  // namespace

double person_height_px(const Track2d& track) {
  using enum JointRole;
  constexpr double kLegOfHeight = 0.491, kUsual = 0.9;  // Drillis and Contini, as body_height
  std::vector<double> legs;
  for (const auto& [hip, knee, ankle] : {std::array{left_hip, left_knee, left_ankle},
                                         std::array{right_hip, right_knee, right_ankle}}) {
    const int first = column_of(track, hip), middle = column_of(track, knee),
              last = column_of(track, ankle);
    if (first < 0 || middle < 0 || last < 0) continue;
    for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
      const double length =
          (pixel_at(track, frame, first) - pixel_at(track, frame, middle)).norm() +
          (pixel_at(track, frame, middle) - pixel_at(track, frame, last)).norm();
      if (std::isfinite(length)) legs.push_back(length);
    }
  }
  return quantile(std::move(legs), kUsual) / kLegOfHeight;
}

std::vector<Keypoint> seen_keypoints(const Track2d& track) {
  std::vector<Keypoint> keypoints = track.keypoints;
  for (std::size_t i = 0; i < keypoints.size(); ++i)
    if (!(track.confidence.col(static_cast<Eigen::Index>(i)).array() > 0).any())
      keypoints[i] = Keypoint{keypoints[i].name, {}, {0, 0, 0}, {}};
  return keypoints;
}

DetectorNoise measured_noise(const Track2d& track, double height_px) {
  constexpr int kLeast = 10;
  if (track.frames() < kLeast)
    throw InputError(fmt::format("a track of {} is too short to measure its noise; {} are needed",
                                 counted(track.frames(), "frame"), kLeast));
  DetectorNoise noise;
  if (const double ratio = noise_ratio(track, height_px, noise); std::isfinite(ratio))
    for (double* part :
         {&noise.bias, &noise.drift, &noise.jitter, &noise.jitter_speed, &noise.hidden})
      *part *= ratio;
  const Gaps gaps = gaps_of(track);
  noise.lost = noise.lost_hidden = gaps.share;
  noise.lost_s = gaps.mean_frames / track.fps;
  std::vector<double> confidences;
  for (const double confidence : track.confidence.reshaped())
    if (confidence > 0) confidences.push_back(std::min(confidence, 1.0));
  if (confidences.empty()) return noise;
  constexpr double kDeviations = 1.2816;  // of a normal distribution below its nine tenths
  const double middle = quantile(confidences, 0.5), low = quantile(confidences, 0.1);
  noise.confidence = middle;
  noise.confidence_spread = (quantile(confidences, 0.9) - middle) / kDeviations;
  noise.confidence_hidden = low;
  noise.confidence_stray = std::min(noise.confidence_stray, low);
  return noise;
}

}  // namespace mcdbn
