#include "camera/detector_track.hpp"

#include "base/numbers.hpp"
#include "camera/keypoint_places.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// Height in pixels of a body of `height` at the depth of the places' mean. @return [frames]
Eigen::VectorXd heights_px(const MatrixD& places, double height, const Camera& camera) {
  Eigen::VectorXd heights(places.rows());
  for (Eigen::Index t = 0; t < places.rows(); ++t) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (Eigen::Index column = 0; column < places.cols(); column += 3) {
      const Eigen::Vector3d place = places.row(t).segment<3>(column).transpose();
      if (place.hasNaN()) continue;
      sum += place;
      ++count;
    }
    const Eigen::Vector3d middle = sum / count;
    const double depth = camera.camera_from_world.row(2) * middle + camera.translation.z();
    heights[t] = camera.fy_px * height / depth;
  }
  return heights;
}

}  // namespace

Track2d exact_track(const MatrixD& places, const std::vector<Keypoint>& keypoints,
                    const Camera& camera, double fps) {
  const auto joints = static_cast<Eigen::Index>(keypoints.size());
  const MatrixD pixels = project_points(camera, places);
  Track2d track;
  track.keypoints = keypoints;
  for (const Keypoint& keypoint : keypoints) track.joint_names.push_back(keypoint.name);
  track.x_px = pixels(Eigen::all, Eigen::seqN(0, joints, 2));
  track.y_px = pixels(Eigen::all, Eigen::seqN(1, joints, 2));
  track.fps = fps;
  track.width_px = camera.width_px;
  track.height_px = camera.height_px;
  const Flags seen = track.x_px.array() >= 0 && track.x_px.array() <= track.width_px &&
                     track.y_px.array() >= 0 && track.y_px.array() <= track.height_px;
  track.confidence = seen.cast<double>();
  for (MatrixD* coordinate : {&track.x_px, &track.y_px})
    *coordinate = seen.select(*coordinate, kNan);
  return track;
}

Track2d detector_track(const Motion& motion, const SkeletonRoles& roles,
                       const std::vector<Keypoint>& keypoints, const Camera& camera,
                       const DetectorNoise& noise, std::uint64_t seed) {
  const MatrixD places = keypoint_places(motion, roles, keypoints);
  Track2d track = exact_track(places, keypoints, camera, motion.fps());
  const RolePositions body{role_positions(motion, roles), body_height(motion.skeleton)};
  detect(track, hidden_places(body, keypoints, places, camera),
         heights_px(places, body.height, camera), noise, seed);
  return track;
}

}  // namespace mcdbn
