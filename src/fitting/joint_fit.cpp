#include "fitting/joint_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/upper_median.hpp"
#include "fitting/frame_fit.hpp"
#include "fitting/robust_residuals.hpp"
#include "fitting/rows_around.hpp"
#include "fitting/series_smoother.hpp"
#include "fitting/standing_foot.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/turned_bones.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/planted_foot.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::infinity();
/// The noise is told from so many frames, spread over the clip (more than a thousand residuals), in
/// so many rounds.
constexpr Eigen::Index kNoiseFrames = 40;
constexpr int kNoiseRounds = 4;
constexpr double kFirstNoise_px = 4;  ///< a guess; the rounds leave it behind
/// How far around a frame its neighbours are asked, and how many times as far, round by round: a
/// bone may be taken for the wrong one over many frames.
constexpr double kNeighbours_s = 1.0 / 15;
constexpr std::array<double, 5> kNeighbourRounds{8, 4, 2, 1, 1};
constexpr StandingOnImage kStanding;

/// One frame of the answer and what the track says of it.
struct Frame {
  FramePrior prior;
  std::vector<Observation> observations;  ///< by tracked joint; the variance for a noise of one
};

/// An answer, what the track says of it, and their measures.
struct Clip {
  std::vector<Frame> frames;
  std::vector<std::size_t> feet;  ///< their indices among the observations
  double depth = 0;               ///< of the root, usually
  double units_per_m = 1, frame_time_s = 1;

  Eigen::Index count() const { return static_cast<Eigen::Index>(frames.size()); }
};

Eigen::Vector2d ray_of(const Eigen::Vector3d& position) {
  return position.head<2>() / position.z();
}

/// By frame, where the answer has the tracked joints; observations still without their rays.
/// @param alone the prior of every frame but for its root and deviations
std::vector<Frame> answer_frames(const Motion& answer, const MatrixD& turn_deviation_rad,
                                 const TurnedBones& bones, const FramePrior& alone,
                                 const Camera& camera) {
  std::vector<Frame> frames;
  for (int t = 0; t < answer.frames(); ++t) {
    const WorldPose pose = forward_kinematics(answer.skeleton, answer.channels.row(t));
    Frame frame{alone, {}};
    frame.prior.root = camera.camera_from_world * pose.position[bones.root()] + camera.translation;
    const auto deviation = turn_deviation_rad.row(t);
    frame.prior.turn_deviation_rad.assign(deviation.begin(), deviation.end());
    for (auto& levers : bones.levers(pose, camera.camera_from_world)) {
      Eigen::Vector3d position = frame.prior.root;
      for (const Lever& lever : levers) position += lever.bone;
      frame.observations.push_back({std::move(levers), ray_of(position), kUnseen});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// What the track says against the answer in one coordinate of one joint, where it shows the joint.
std::vector<Measured> differences(const std::vector<Frame>& frames, const TrackRays& track,
                                  Eigen::Index joint, int axis, double variance) {
  std::vector<Measured> series(frames.size(), {0, kUnseen});
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const auto row = static_cast<Eigen::Index>(t);
    const double answer = frames[t].observations[joint].ray[axis];
    if (!track.seen(row, joint) || !std::isfinite(answer)) continue;
    series[t] = {track.rays(row, 2 * joint + axis) - answer,
                 variance / track.confidence(row, joint)};
  }
  return series;
}

double mean_square(const std::vector<Measured>& series) {
  double sum = 0, count = 0;
  for (const Measured& measured : series) {
    if (std::isinf(measured.variance)) continue;
    sum += measured.value * measured.value;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// Gives the observations the rays of the track. Where it does not show a joint, what it said
/// against the answer before and after goes on, ever less sure, so that nothing jumps when a joint
/// is lost.
/// @param variance of a ray that is seen
void look_at(const TrackRays& track, double variance, double fade_s, double frame_time_s,
             std::vector<Frame>& frames) {
  for (Eigen::Index joint = 0; joint < track.joints(); ++joint) {
    for (int axis = 0; axis < 2; ++axis) {
      const std::vector<Measured> seen = differences(frames, track, joint, axis, variance);
      const double spread = std::max(mean_square(seen), variance);
      const std::vector<Measured> known =
          smooth_series(seen, SeriesDynamics::around_zero(spread, fade_s, frame_time_s));
      for (std::size_t t = 0; t < frames.size(); ++t) {
        Observation& observation = frames[t].observations[joint];
        const Measured said =
            std::isinf(seen[t].variance) ? without(known[t], {0, spread}) : seen[t];
        observation.ray[axis] += said.value;
        observation.variance = said.variance / variance;
      }
    }
  }
}

bool says_something(const Observation& observation) {
  return std::isfinite(observation.variance) && observation.ray.allFinite();
}

/// The observations that say anything, for a noise of that deviation.
std::vector<Observation> usable(const Frame& frame, double noise) {
  std::vector<Observation> observations;
  for (const Observation& observation : frame.observations) {
    if (!says_something(observation)) continue;
    observations.push_back(observation);
    observations.back().variance *= noise * noise;
  }
  return observations;
}

/// Squares that stop growing: a joint that was swapped says nothing of the noise.
double clipped_square(double miss) {
  constexpr double kLargestMiss = 4;
  return miss * miss / (1 + miss * miss / (kLargestMiss * kLargestMiss));
}

/// How far off the rays are: what the fit leaves, counted for what it uses up (MacKay's evidence).
/// As the fit depends on it in turn, in rounds.
/// @param start a guess, `least` the least answer
double residual_scale(const std::vector<Frame>& frames, double start, double least) {
  const auto count = static_cast<Eigen::Index>(frames.size());
  const Eigen::Index stride = std::max<Eigen::Index>(1, count / kNoiseFrames);
  double noise = start;
  for (int round = 0; round < kNoiseRounds; ++round) {
    double squares = 0, freedom = 0;
    for (Eigen::Index t = stride / 2; t < count; t += stride) {
      const FramePrior& prior = frames[t].prior;
      const std::vector<Observation> observations = usable(frames[t], noise);
      const FrameFit fit = fit_frame(observations, prior);
      for (const double miss : fit.residuals) squares += clipped_square(miss);
      freedom += freedom_of(fit, observations, prior);
    }
    if (!(freedom > 0)) break;
    noise = std::max(least, noise * std::sqrt(squares / freedom));
  }
  return std::max(least, noise);
}

/// The deviation of the Gaussian that is off least, in frames: of width w it leaves
/// noise² / (2 √π w) of the noise's variance and bends the path by w² bend / 2.
double best_width_frames(double noise_m, double bend_m_s2, double frame_time_s) {
  const double ratio = noise_m / (bend_m_s2 * frame_time_s * frame_time_s);
  return std::pow(ratio * ratio / (2 * std::sqrt(std::numbers::pi)), 0.2);
}

/// How far the root is from the camera in the middle frame by distance.
double usual_depth(const std::vector<Frame>& frames) {
  std::vector<double> depths;
  depths.reserve(frames.size());
  for (const Frame& frame : frames) depths.push_back(frame.prior.root.z());
  return upper_median(std::move(depths));
}

FramePrior prior_alone(const TurnedBones& bones, const TrackFitSettings& fit, double units_per_m) {
  FramePrior prior;
  prior.parents = bones.parents();
  prior.likeness = fit.likeness;
  prior.root_deviation = fit.position_m * units_per_m;
  return prior;
}

/// Indices of the feet among the joints.
std::vector<std::size_t> feet_among(const std::vector<int>& joints, const Skeleton& skeleton) {
  const std::vector<int> feet = foot_joints(skeleton);
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (std::find(feet.begin(), feet.end(), joints[k]) != feet.end()) indices.push_back(k);
  }
  return indices;
}

/// @param turns [frames x 3·orientations] radians
MatrixD turned(MatrixD features, const MatrixD& turns) {
  for (Eigen::Index t = 0; t < features.rows(); ++t) {
    for (Eigen::Index k = 0; k < turns.cols() / 3; ++k) {
      const Eigen::Matrix3d rotation = rotation_of(turns.row(t).segment<3>(3 * k).transpose());
      auto block = features.row(t).segment<PoseFeatures::kBlock>(PoseFeatures::kBlock * k);
      block.head<3>() *= rotation.transpose();
      block.tail<3>() *= rotation.transpose();
    }
  }
  return features;
}

/// The prior of a frame whose neighbours' mean correction is known: what both say together.
/// @param change deviation from the neighbours', as a share of the prior's own
FramePrior beside(const RowVectorD& neighbours, double change, FramePrior prior) {
  const double both = 1 + change * change;
  const double share = change / std::sqrt(both);
  prior.expected = neighbours.transpose() / both;
  for (double& deviation : prior.turn_deviation_rad) deviation *= share;
  prior.root_deviation *= share;
  return prior;
}

/// What the frames around say of one foot. @param corrections [frames x parameters] so far
std::vector<FootDepth> depths_around(const Clip& clip, std::size_t foot,
                                     const MatrixD& corrections) {
  std::vector<SeenFoot> seen;
  for (Eigen::Index t = 0; t < clip.count(); ++t) {
    const Frame& frame = clip.frames[t];
    const Observation& observation = frame.observations[foot];
    const Eigen::VectorXd correction = corrections.row(t).transpose();
    const bool shown = says_something(observation);
    seen.push_back({shown ? observation.ray : Eigen::Vector2d(0, 0),
                    shown ? 1 / std::max(1.0, observation.variance) : 0,
                    corrected_position(observation.levers, frame.prior.root, correction).z()});
  }
  return standing_depths(seen, kStanding.still_m * clip.units_per_m / clip.depth,
                         std::max(0.5, kStanding.around_s / clip.frame_time_s));
}

/// The feet that stand, by frame, at the depth they have in the frames around.
std::vector<std::vector<HeldDepth>> held_feet(const Clip& clip, double footing,
                                              const MatrixD& corrections) {
  std::vector<std::vector<HeldDepth>> held(clip.frames.size());
  for (const std::size_t foot : clip.feet) {
    const std::vector<FootDepth> depths = depths_around(clip, foot, corrections);
    for (std::size_t t = 0; t < held.size(); ++t) {
      if (!(depths[t].surely > 0)) continue;
      held[t].push_back({clip.frames[t].observations[foot].levers, depths[t].depth,
                         footing * footing / depths[t].surely});
    }
  }
  return held;
}

/// The turns of every frame: first each for itself, then as its neighbours make them likely. A bone
/// that leans towards the camera looks like one that leans away from it as much; where a frame took
/// it for the wrong one its neighbours tell.
/// @return [frames x 3·orientations] radians
MatrixD solve(const Clip& clip, double noise, const TrackFitSettings& fit) {
  const auto turns = 3 * static_cast<Eigen::Index>(clip.frames.front().prior.parents.size());
  MatrixD corrections(clip.count(), turns + 3);
  std::vector<std::vector<Observation>> observations;
  for (const Frame& frame : clip.frames) observations.push_back(usable(frame, noise));
  const auto solve_frame = [&](Eigen::Index t, const FramePrior& prior) {
    corrections.row(t) = fit_frame(observations[t], prior).correction.transpose();
  };
  for (Eigen::Index t = 0; t < clip.count(); ++t) solve_frame(t, clip.frames[t].prior);
  if (clip.count() == 1) return corrections.leftCols(turns);
  const double around = std::max(0.5, kNeighbours_s / clip.frame_time_s);
  for (std::size_t round = 0; round < kNeighbourRounds.size(); ++round) {
    const double reach = around * kNeighbourRounds[round];
    // Frames by themselves can be far off, so that at first most of them have it.
    const auto neighbours = round == 0 ? median_around : mean_around;
    const auto held = held_feet(clip, fit.footing_m * clip.units_per_m, corrections);
    for (Eigen::Index t = 0; t < clip.count(); ++t) {
      FramePrior prior =
          beside(neighbours(corrections, t, reach), fit.change, clip.frames[t].prior);
      prior.held = held[t];
      solve_frame(t, prior);
    }
  }
  return corrections.leftCols(turns);
}

void check_shapes(const PoseFeatures& pose_features, const MatrixD& features,
                  const MatrixD& turn_deviation_rad, const Motion& answer, const TrackRays& track) {
  const auto turns = static_cast<Eigen::Index>(pose_features.joints().size());
  const auto frames = features.rows();
  if (features.cols() == pose_features.dimension() && frames == answer.frames() &&
      frames == track.frames() && frames == turn_deviation_rad.rows() &&
      turn_deviation_rad.cols() == turns) {
    return;
  }
  throw ShapeError(fmt::format(
      "fit_joints: features {}x{}, expected {} columns; deviations {}x{}, expected {} columns; as "
      "many rows as the answer ({}) and the track ({}) have frames",
      frames, features.cols(), pose_features.dimension(), turn_deviation_rad.rows(),
      turn_deviation_rad.cols(), turns, answer.frames(), track.frames()));
}

std::vector<int> joints_of(const TrackRays& track, const Skeleton& skeleton) {
  std::vector<int> joints;
  for (const std::string& name : track.joint_names) {
    joints.push_back(skeleton.find(name));
    if (joints.back() < 0) throw InputError(fmt::format("the answer lacks the joint {}", name));
  }
  return joints;
}

}  // namespace

MatrixD fit_joints(const PoseFeatures& pose_features, const MatrixD& features,
                   const MatrixD& turn_deviation_rad, const Motion& answer, const TrackRays& track,
                   double track_noise_px, const Camera& camera, const TrackFitSettings& fit) {
  check_shapes(pose_features, features, turn_deviation_rad, answer, track);
  if (features.rows() == 0) return features;
  const std::vector<int> joints = joints_of(track, answer.skeleton);
  const TurnedBones bones(pose_features, answer.skeleton, joints);
  Clip clip;
  clip.units_per_m = file_units_per_metre(answer.skeleton);
  clip.frames = answer_frames(answer, turn_deviation_rad, bones,
                              prior_alone(bones, fit, clip.units_per_m), camera);
  clip.feet = feet_among(joints, answer.skeleton);
  clip.depth = usual_depth(clip.frames);
  clip.frame_time_s = 1 / track.fps;

  const double focal_px = std::sqrt(camera.fx_px * camera.fy_px);
  const double track_noise = std::max(kLeastNoise_px, track_noise_px) / focal_px;
  look_at(track, track_noise * track_noise, fit.fade_s, clip.frame_time_s, clip.frames);
  const double least =
      std::max(track_noise, fit.proportions_m * clip.units_per_m / std::max(clip.depth, 1e-9));
  // What a bone's length on the image is off by is taken for depth, most where the bone hardly
  // leans: noise there does not average out.
  const double noise =
      fit.caution * residual_scale(clip.frames, std::max(least, kFirstNoise_px / focal_px), least);

  MatrixD turns = solve(clip, noise, fit);
  const double noise_m = track_noise * clip.depth / clip.units_per_m;
  if (noise_m > 0) {
    turns = smoothed_rows(turns, best_width_frames(noise_m, fit.bend_m_s2, clip.frame_time_s));
  }
  return turned(features, turns);
}

}  // namespace mcdbn
