#include "camera/lens.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "base/numbers.hpp"

namespace mcdbn {
namespace {

/// Of a ray that is 84 degrees aside: as x/z and y/z those further out grow without bound.
constexpr double kSteepest = 10;

cv::Matx33d intrinsics(const Camera& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

cv::Vec4d fisheye_distortion(const Camera& camera) {
  cv::Vec4d k(0, 0, 0, 0);
  for (std::size_t i = 0; i < camera.distortion.size() && i < 4; ++i)
    k[static_cast<int>(i)] = camera.distortion[i];
  return k;
}

}  // namespace

void project_through_lens(const Camera& camera, const cv::Mat& world, cv::Mat& pixels) {
  cv::Mat camera_from_world, rotation;
  cv::eigen2cv(camera.camera_from_world, camera_from_world);
  cv::Rodrigues(camera_from_world, rotation);
  const cv::Vec3d translation(camera.translation.x(), camera.translation.y(),
                              camera.translation.z());
  if (camera.fisheye)
    cv::fisheye::projectPoints(world, pixels, rotation, translation, intrinsics(camera),
                               fisheye_distortion(camera));
  else
    cv::projectPoints(world, rotation, translation, intrinsics(camera), camera.distortion, pixels);
}

bool is_before_lens(const Camera& camera, const Eigen::Vector3d& point) {
  return point.z() > 0 && (!camera.fisheye || point.head<2>().norm() < kSteepest * point.z());
}

std::vector<cv::Point2d> rays_of(const Camera& camera, const std::vector<cv::Point2d>& pixels) {
  std::vector<cv::Point2d> rays;
  if (pixels.empty()) return rays;
  // More rounds than OpenCV's five, which leave tenths of a pixel at the edge of a wide lens.
  const cv::TermCriteria rounds(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-10);
  if (!camera.fisheye) {
    cv::undistortPoints(pixels, rays, intrinsics(camera), camera.distortion, cv::noArray(),
                        cv::noArray(), rounds);
    return rays;
  }
  cv::fisheye::undistortPoints(pixels, rays, intrinsics(camera), fisheye_distortion(camera),
                               cv::noArray(), cv::noArray(), rounds);
  // OpenCV gives -1e6 where it finds no ray, and some ray for NaN.
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!std::isfinite(pixels[i].x) || !std::isfinite(pixels[i].y) ||
        !(std::hypot(rays[i].x, rays[i].y) < kSteepest))
      rays[i] = {kNan, kNan};
  return rays;
}

}  // namespace mcdbn
