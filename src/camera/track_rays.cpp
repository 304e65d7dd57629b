#include "camera/track_rays.hpp"

#include "camera/lens.hpp"

namespace mcdbn {
namespace {

/// @return [frames x 2·columns], NaN where missing
MatrixD undistorted(const Track2d& track, const std::vector<int>& columns, const Camera& camera) {
  std::vector<cv::Point2d> pixels;
  for (int frame = 0; frame < track.frames(); ++frame) {
    for (const int column : columns) {
      pixels.emplace_back(track.x_px(frame, column), track.y_px(frame, column));
    }
  }
  const std::vector<cv::Point2d> rays = rays_of(camera, pixels);
  MatrixD result(track.frames(), 2 * static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < rays.size(); ++k) {
    result.data()[2 * k] = rays[k].x;
    result.data()[2 * k + 1] = rays[k].y;
  }
  return result;
}

}  // namespace

TrackRays track_rays(const std::vector<std::string>& joint_names, const Track2d& track,
                     const Camera& camera) {
  TrackRays result;
  result.asked = static_cast<int>(joint_names.size());
  result.fps = track.fps;
  std::vector<int> columns;
  for (std::size_t k = 0; k < joint_names.size(); ++k) {
    const int column = track.find(joint_names[k]);
    if (column < 0) continue;
    result.joint_names.push_back(joint_names[k]);
    result.indices.push_back(static_cast<int>(k));
    columns.push_back(column);
  }
  result.rays = undistorted(track, columns, camera);
  result.confidence.resize(track.frames(), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index frame = 0; frame < result.frames(); ++frame) {
    for (Eigen::Index joint = 0; joint < result.joints(); ++joint) {
      const double confidence = track.confidence(frame, columns[joint]);
      const bool seen =
          confidence > 0 && result.rays.row(frame).segment<2>(2 * joint).array().isFinite().all();
      result.confidence(frame, joint) = seen ? confidence : 0;
    }
  }
  return result;
}

}  // namespace mcdbn
