#include "mcdbn/motion_model/clip_generation.hpp"

#include <fmt/format.h>

#include "base/counted.hpp"
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

}  // namespace

std::vector<Motion> generate_clip(const Model& model, const Motion& seed,
                                  const GenerationOptions& options, GenerationHealth* health) {
  const Modalities& modalities = model.modalities;
  if (is_humanoid(modalities.pose_features.skeleton()) && !is_humanoid(seed.skeleton)) {
    const HumanoidRig rig = rig_of_person(seed);
    std::vector<Motion> motions = generate_clip(model, rig.to_humanoid(seed), options, health);
    for (Motion& motion : motions) motion = rig.from_humanoid(motion);
    return motions;
  }
  const Cdbn& cdbn = model.network.cdbns[kPose];
  const Motion at_rate = resample(seed, modalities.fps);
  if (at_rate.frames() < static_cast<int>(seed_frames(cdbn)))
    throw InputError(
        fmt::format("the seed clip has {} at the model's {:g} fps, the network looks at {}; give a "
                    "longer one",
                    counted(at_rate.frames(), "frame"), modalities.fps, seed_frames(cdbn)));
  const Eigen::Matrix3d camera_from_world = camera_at_origin(modalities.camera).camera_from_world,
                        axes_from_world = modalities.pose_axes(camera_from_world);
  const Skeleton& skeleton = at_rate.skeleton;
  const WorldPose last = forward_kinematics(skeleton, at_rate.channels.bottomRows(1));
  const Eigen::Vector3d start =
      last.position[static_cast<std::size_t>(skeleton.find(modalities.root_name()))];
  const auto poses = generate(cdbn, {modalities.encode_pose(at_rate, camera_from_world)}, options);
  if (health) *health = generation_health(poses);
  std::vector<Motion> motions;
  for (const MatrixF& pose : poses) {
    const MatrixD features = modalities.pose_scale.invert(pose);
    motions.push_back(modalities.pose_features.decode(
        features, axes_from_world, skeleton, modalities.fps,
        root_path(modalities.pose_features.root_features(features), axes_from_world, modalities.fps,
                  file_units_per_metre(skeleton), start)));
  }
  return motions;
}

}  // namespace mcdbn
