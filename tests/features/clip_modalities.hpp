#pragma once

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/features/modalities.hpp"

namespace mcdbn::test {

/// What a model of these clips, seen from `view`, makes of motion and tracks.
inline Modalities modalities_of(const std::vector<Motion>& clips, const CameraPlacement& view) {
  std::vector<const Motion*> pointers;
  for (const Motion& clip : clips) pointers.push_back(&clip);
  const PoseFeatures pose_features = PoseFeatures::fit(pointers);
  const TrackFeatures track_features =
      TrackFeatures::for_skeleton(pose_features.skeleton(), pose_features.root());
  std::vector<MatrixD> poses, tracks;
  for (const Motion& clip : clips) {
    const Camera camera = place_camera(clip, view);
    poses.push_back(pose_features.encode(clip, camera.camera_from_world));
    tracks.push_back(track_features.encode(project_motion(clip, camera)));
  }
  std::vector<const MatrixD*> pose_blocks, track_blocks;
  for (const MatrixD& block : poses) pose_blocks.push_back(&block);
  for (const MatrixD& block : tracks) track_blocks.push_back(&block);
  return {pose_features,
          track_features,
          Standardizer::fit(pose_blocks),
          Standardizer::fit(track_blocks),
          clips.front().fps(),
          view};
}

/// Joints about joint `origin`. @return [frames x 3·names]
inline MatrixD joints_about(const Motion& motion, const std::vector<std::string>& names,
                            const std::string& origin) {
  const MatrixD all = joint_positions(motion);
  MatrixD result(all.rows(), 3 * static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i)
    result.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
        all.middleCols(3 * motion.skeleton.find(names[i]), 3) -
        all.middleCols(3 * motion.skeleton.find(origin), 3);
  return result;
}

/// The path of joint `name` through the world. @return [frames x 3]
inline MatrixD path_of(const Motion& motion, const std::string& name) {
  return joint_positions(motion).middleCols(3 * motion.skeleton.find(name), 3);
}

}  // namespace mcdbn::test
