#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// World points to pixels, also those that the camera does not see.
/// @param world a column of 3 doubles  @param pixels a column of 2, filled in place
void project_through_lens(const Camera& camera, const cv::Mat& world, cv::Mat& pixels);

/// How far aside the lens can see, as the length of a ray (x/z, y/z) in camera axes. A fisheye sees
/// to 84 degrees. A pinhole sees as far as its radial distortion puts what is further out further
/// from the middle: where that turns back, points would come into the image again. Infinity where
/// it never does, as without distortion.
double steepest_ray(const Camera& camera);

/// Whether the lens can see a point in camera axes: it is before it, and not too far aside.
/// @param steepest steepest_ray() of the camera
bool is_before_lens(const Eigen::Vector3d& point, double steepest);

/// Pixels to rays, x/z and y/z in camera axes; not finite where there is none.
std::vector<cv::Point2d> rays_of(const Camera& camera, const std::vector<cv::Point2d>& pixels);

}  // namespace mcdbn
