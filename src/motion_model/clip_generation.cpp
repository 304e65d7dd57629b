#include "mcdbn/motion_model/clip_generation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/counted.hpp"
#include "base/named_errors.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/body_size.hpp"
#include "motion/resample.hpp"

namespace mcdbn {
namespace {

/// World, file units: the height as the features have it, the rest summed up from `start` on.
/// @param root of PoseFeatures::root_features
MatrixD root_path(const MatrixD& root, const Eigen::Matrix3d& axes_from_world, double fps,
                  double units_per_metre, const Eigen::Vector3d& start) {
  MatrixD path = units_per_metre / fps * root.rightCols(3) * axes_from_world;
  Eigen::RowVector3d position = start.transpose();
  for (Eigen::Index t = 0; t < path.rows(); ++t) {
    position += path.row(t);
    position.y() = units_per_metre * root(t, 0);
    path.row(t) = position;
  }
  return path;
}

/// A seed on the model's joints and at its rate, and the way back.
struct PreparedSeed {
  Motion motion;
  std::optional<HumanoidRig> rig;  ///< where the model is the humanoid's and the seed is not
};

/// camera_from_world of each direction that the network has seen clips from.
std::vector<Eigen::Matrix3d> directions_of(const Modalities& modalities) {
  std::vector<Eigen::Matrix3d> rotations;
  for (const CameraPlacement& placement :
       placements_around(modalities.camera, modalities.directions))
    rotations.push_back(camera_at_origin(placement).camera_from_world);
  return rotations;
}

PreparedSeed prepared(const Model& model, const Motion& seed) {
  const Modalities& modalities = model.modalities;
  PreparedSeed own;
  if (is_humanoid(modalities.pose_features.skeleton()) && !is_humanoid(seed.skeleton))
    own.rig = rig_of_person(seed);
  own.motion = resample(own.rig ? own.rig->to_humanoid(seed) : seed, modalities.fps);
  const std::size_t needed = seed_frames(model.network.cdbns[kPose]);
  if (own.motion.frames() < static_cast<int>(needed))
    throw InputError(
        fmt::format("the seed clip has {} at the model's {:g} fps, the network looks at {}; give a "
                    "longer one",
                    counted(own.motion.frames(), "frame"), modalities.fps, needed));
  return own;
}

/// Where in a clip samples begin.
struct Moment {
  std::size_t clip;
  Eigen::Index frames;  ///< of the clip, up to it
};

/// Moments of one clip, in order; the last is its end.
std::vector<Moment> moments_of(std::size_t clip, const Motion& seed, double every_s,
                               Eigen::Index least_frames) {
  std::vector<Moment> moments{{clip, seed.frames()}};
  if (every_s > 0) {
    const double step = std::max(1.0, every_s * seed.fps());
    for (double frames = seed.frames() - step; std::lround(frames) >= least_frames; frames -= step)
      moments.push_back({clip, std::lround(frames)});
  }
  std::ranges::reverse(moments);
  return moments;
}

/// The moments that the samples continue, one after another.
struct Starts {
  Eigen::Index frames;  ///< that the network looks at
  std::vector<Moment> moments = {};
  std::vector<MatrixF> features = {};  ///< the last frames before each moment, for each sample
  std::vector<double> speed = {};      ///< mean_speed of the whole clip, for each sample

  /// @param directions camera_from_world; the samples take them in turn
  void add(const Modalities& modalities, const Motion& seed, const std::vector<Moment>& of_seed,
           const std::vector<Eigen::Matrix3d>& directions, std::size_t samples) {
    std::vector<MatrixF> seen;
    std::vector<double> seen_speed;
    for (std::size_t i = 0; i < std::min(samples, directions.size()); ++i) {
      seen.push_back(modalities.encode_pose(seed, directions[i]));
      seen_speed.push_back(mean_speed(seen.back()));
    }
    for (const Moment& moment : of_seed) {
      moments.push_back(moment);
      for (std::size_t i = 0; i < samples; ++i) {
        const std::size_t direction = i % seen.size();
        features.emplace_back(seen[direction].middleRows(moment.frames - frames, frames));
        speed.push_back(seen_speed[direction]);
      }
    }
  }
};

/// @throws ConfigError for more numbers than kernels count to, in 32 bits
void check_amount(const Crbm& layer, std::size_t sequences, const GenerationOptions& options) {
  const double widest = static_cast<double>(std::max(layer.shape().visible, layer.shape().hidden)),
               numbers = widest * static_cast<double>(sequences) *
                         static_cast<double>(options.frames + layer.shape().order);
  if (numbers > std::numeric_limits<std::int32_t>::max())
    throw ConfigError(fmt::format(
        "`frames` ({}) in {} are {:.2g} numbers; {:.2g} are the most: lower `frames` or `samples`",
        options.frames, counted(sequences, "sequence"), numbers,
        static_cast<double>(std::numeric_limits<std::int32_t>::max())));
}

/// The generated motion on the seed's skeleton, continued from the place of its person.
/// @param frames_before frames of the seed before the motion
Motion decoded(const Modalities& modalities, const MatrixF& pose, const PreparedSeed& seed,
               Eigen::Index frames_before, const Eigen::Matrix3d& axes_from_world) {
  const Skeleton& skeleton = seed.motion.skeleton;
  const WorldPose last =
      forward_kinematics(skeleton, seed.motion.channels.middleRows(frames_before - 1, 1));
  const Eigen::Vector3d start =
      last.position[static_cast<std::size_t>(skeleton.find(modalities.root_name()))];
  const MatrixD features = modalities.pose_scale.invert(pose);
  const Motion motion = modalities.pose_features.decode(
      features, axes_from_world, skeleton, modalities.fps,
      root_path(modalities.pose_features.root_features(features), axes_from_world, modalities.fps,
                file_units_per_metre(skeleton), start));
  return seed.rig ? seed.rig->from_humanoid(motion) : motion;
}

}  // namespace

std::vector<Motion> generate_clips(const Model& model, const std::vector<SeedClip>& seeds,
                                   const GenerationOptions& options, GenerationHealth* health) {
  const Modalities& modalities = model.modalities;
  const Cdbn& cdbn = model.network.cdbns[kPose];
  const std::vector<Eigen::Matrix3d> directions = directions_of(modalities);
  std::vector<PreparedSeed> prepared_seeds;
  Starts starts{static_cast<Eigen::Index>(seed_frames(cdbn))};
  for (const SeedClip& seed : seeds) {
    with_name(seed.name, [&] {
      const std::size_t clip = prepared_seeds.size();
      const Motion& motion = prepared_seeds.emplace_back(prepared(model, seed.motion)).motion;
      starts.add(modalities, motion, moments_of(clip, motion, seed.every_s, starts.frames),
                 directions, options.samples);
    });
  }
  for (const Crbm& layer : cdbn.layers) check_amount(layer, starts.features.size(), options);
  GenerationOptions of_each = options;
  of_each.samples = 1;
  const auto poses = generate(cdbn, starts.features, of_each);
  if (health) *health = generation_health(poses, starts.speed);
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Moment& moment = starts.moments[i / options.samples];
    motions.push_back(
        decoded(modalities, poses[i], prepared_seeds[moment.clip], moment.frames,
                modalities.pose_axes(directions[i % options.samples % directions.size()])));
  }
  return motions;
}

}  // namespace mcdbn
