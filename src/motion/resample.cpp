#include "motion/resample.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/counted.hpp"
#include "base/interruption.hpp"
#include "base/numbers.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {
namespace {

/// Cut-off (−6 dB) as a fraction of the new rate, and half the filter's length in new frames:
/// a Hann-windowed sinc of this length falls off within ±0.1 of the new rate.
constexpr double kCutoff = 0.4;
constexpr double kHalfLength = 8.0;

bool has_rotation(const Joint& joint) {
  return std::any_of(joint.channels.begin(), joint.channels.end(), is_rotation);
}

/// The clip as signals that may be averaged: for each joint a quaternion (w x y z) of one sign over
/// time if it turns, then its position channels. @return [frames x signals]
MatrixD to_signals(const Motion& motion) {
  Eigen::Index columns = 0;
  for (const Joint& joint : motion.skeleton.joints) {
    const auto rotations = std::count_if(joint.channels.begin(), joint.channels.end(), is_rotation);
    columns +=
        (rotations > 0 ? 4 : 0) + static_cast<Eigen::Index>(joint.channels.size()) - rotations;
  }
  MatrixD signals(motion.frames(), columns);
  for (int frame = 0; frame < motion.frames(); ++frame) {
    const double* channels = motion.channels.row(frame).data();
    Eigen::Index column = 0;
    for (const Joint& joint : motion.skeleton.joints) {
      if (has_rotation(joint)) {
        const Eigen::Quaterniond turn(local_rotation(joint, channels));
        Eigen::RowVector4d values(turn.w(), turn.x(), turn.y(), turn.z());
        // q and −q are the same rotation; averaging needs the one nearer to the frame before.
        if (frame > 0 && values.dot(signals.block<1, 4>(frame - 1, column)) < 0) values = -values;
        signals.block<1, 4>(frame, column) = values;
        column += 4;
      }
      for (std::size_t i = 0; i < joint.channels.size(); ++i) {
        if (!is_rotation(joint.channels[i])) signals(frame, column++) = channels[i];
      }
      channels += joint.channels.size();
    }
  }
  return signals;
}

/// Half of a symmetric Hann-windowed sinc with unit gain at 0 Hz: the middle tap, then outwards.
std::vector<double> low_pass_taps(double cutoff_per_frame, Eigen::Index half_length) {
  std::vector<double> taps;
  double sum = 0;
  for (Eigen::Index n = 0; n <= half_length; ++n) {
    const double angle = std::numbers::pi * static_cast<double>(n);
    const double x = 2 * cutoff_per_frame * angle;
    const double window = 0.5 + 0.5 * std::cos(angle / static_cast<double>(half_length + 1));
    taps.push_back((n == 0 ? 1.0 : std::sin(x) / x) * window);
    sum += (n == 0 ? 1 : 2) * taps.back();
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

/// Filters every column with zero phase. Beyond its ends the clip goes on as its own point
/// reflection, which keeps the end values and the speed there.
/// @param step new frames in old ones, more than 1
MatrixD low_pass(const MatrixD& signals, double step) {
  const Eigen::Index frames = signals.rows();
  const Eigen::Index half =
      std::min(static_cast<Eigen::Index>(std::ceil(kHalfLength * step)), frames - 1);
  const std::vector<double> taps = low_pass_taps(kCutoff / step, half);

  MatrixD padded(frames + 2 * half, signals.cols());
  padded.middleRows(half, frames) = signals;
  for (Eigen::Index n = 1; n <= half; ++n) {
    padded.row(half - n) = 2 * signals.row(0) - signals.row(n);
    padded.row(half + frames - 1 + n) = 2 * signals.row(frames - 1) - signals.row(frames - 1 - n);
  }
  MatrixD filtered = taps[0] * signals;
  for (Eigen::Index n = 1; n <= half; ++n) {
    filtered += taps[static_cast<std::size_t>(n)] *
                (padded.middleRows(half - n, frames) + padded.middleRows(half + n, frames));
  }
  return filtered;
}

Eigen::Quaterniond quaternion_at(const MatrixD& signals, Eigen::Index frame, Eigen::Index column) {
  const Eigen::RowVector4d q = signals.block<1, 4>(frame, column);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

/// Writes one frame of channels from the signals at `source_frame` (in their own frames).
/// @param previous the channels of the frame before, for continuous angles
void sample(const Skeleton& skeleton, const MatrixD& signals, double source_frame,
            const double* previous, double* channels) {
  const auto before = std::min(static_cast<Eigen::Index>(source_frame), signals.rows() - 1);
  const Eigen::Index after = std::min(before + 1, signals.rows() - 1);
  const double part = source_frame - static_cast<double>(before);
  Eigen::Index column = 0;
  for (const Joint& joint : skeleton.joints) {
    if (has_rotation(joint)) {
      const Eigen::Quaterniond turn =
          quaternion_at(signals, before, column).slerp(part, quaternion_at(signals, after, column));
      set_local_rotation(joint, turn.toRotationMatrix(), previous, channels);
      column += 4;
    }
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      if (is_rotation(joint.channels[i])) continue;
      channels[i] = (1 - part) * signals(before, column) + part * signals(after, column);
      ++column;
    }
    channels += joint.channels.size();
    previous += joint.channels.size();
  }
}

/// Gives channels that never change in `source` their exact value back, where only rounding moved
/// them: code that drops constant channels has to recognize them.
void restore_constants(const MatrixD& source, MatrixD& resampled) {
  constexpr double kRounding = 1e-6;
  for (Eigen::Index column = 0; column < source.cols(); ++column) {
    const double value = source(0, column);
    const bool constant = (source.col(column).array() == value).all();
    if (constant && ((resampled.col(column).array() - value).abs() < kRounding).all()) {
      resampled.col(column).setConstant(value);
    }
  }
}

/// The largest turn (degrees) of a joint against its parent from one frame to the next.
double largest_turn_deg(const Motion& motion, int frame) {
  double largest = 0;
  int first = 0;
  for (const Joint& joint : motion.skeleton.joints) {
    const Eigen::Quaterniond from(local_rotation(joint, motion.channels.row(frame).data() + first));
    const Eigen::Quaterniond to(
        local_rotation(joint, motion.channels.row(frame + 1).data() + first));
    largest = std::max(largest, from.angularDistance(to));
    first += static_cast<int>(joint.channels.size());
  }
  return largest / kRadiansPerDegree;
}

/// Whether a frame's rotations are whole degrees and at least three in four of them zero.
bool is_authored_pose(const Motion& motion, int frame) {
  int rotations = 0, zeros = 0, column = 0;
  for (const Joint& joint : motion.skeleton.joints) {
    for (const Channel channel : joint.channels) {
      const double value = motion.channels(frame, column++);
      if (!is_rotation(channel)) continue;
      if (value != std::round(value)) return false;
      ++rotations;
      zeros += value == 0;
    }
  }
  return 4 * zeros >= 3 * rotations;
}

void check_arguments(const Motion& motion, double phase) {
  if (!(phase >= 0 && phase < 1)) {
    throw ConfigError(fmt::format("resample: phase {} must be at least 0 and below 1", phase));
  }
  if (motion.frames() == 0) throw ShapeError("resample: the clip has no frames");
}

}  // namespace

bool has_leading_calibration_pose(const Motion& motion) {
  // A joint that turns this much in one frame, and then goes on at a third of it, was not moved.
  constexpr double kJump_deg = 10.0;
  constexpr double kTimesNextTurn = 3.0;
  if (motion.frames() < 3 || !is_authored_pose(motion, 0)) return false;
  const double jump_deg = largest_turn_deg(motion, 0);
  return jump_deg > kJump_deg && jump_deg > kTimesNextTurn * largest_turn_deg(motion, 1);
}

Motion without_first_frame(const Motion& motion) {
  if (motion.frames() < 2) throw ShapeError("without_first_frame: nothing would be left");
  return {motion.skeleton, motion.frame_time_s, motion.channels.bottomRows(motion.frames() - 1)};
}

int frames_at_rate(int frames, double rate_hz, double target_hz, double phase, double slack) {
  check_range("a frame rate in Hz", kFrameRate_hz, rate_hz);
  check_range("a frame rate in Hz", kFrameRate_hz, target_hz);
  const double last = std::floor((frames - 1) / (rate_hz / target_hz) - phase + slack);
  if (last >= kMostFrames)
    throw InputError(fmt::format(
        "{} at {:g} Hz would become {:.0f} at {:g} Hz, at most {:.0f} are made; is the rate "
        "right?",
        counted(frames, "frame"), rate_hz, last + 1, target_hz, kMostFrames));
  return std::max(1, static_cast<int>(last) + 1);
}

Motion resample(const Motion& motion, double target_hz, double phase, double same_rate) {
  check_arguments(motion, phase);
  // The last frame is kept although a printed frame time puts it a little past the end.
  constexpr double kSlack = 1e-3;
  const int frames = frames_at_rate(motion.frames(), motion.fps(), target_hz, phase, kSlack);
  const double step = motion.fps() / target_hz;
  const bool is_same = std::abs(step - 1) <= same_rate;
  if (is_same && phase == 0) return motion;

  MatrixD signals = to_signals(motion);
  if (step > 1 && !is_same) signals = low_pass(signals, step);

  const double last_frame = motion.frames() - 1;
  Motion result{motion.skeleton, 1.0 / target_hz, MatrixD(frames, motion.channels.cols())};
  for (int frame = 0; frame < frames; ++frame) {
    check_interruption();
    const double source_frame = std::min((frame + phase) * step, last_frame);
    // The first frame takes the branch of angles that the file itself uses there.
    const double* previous = frame > 0 ? result.channels.row(frame - 1).data()
                                       : motion.channels.row(static_cast<int>(source_frame)).data();
    sample(motion.skeleton, signals, source_frame, previous, result.channels.row(frame).data());
  }
  restore_constants(motion.channels, result.channels);
  return result;
}

}  // namespace mcdbn
