#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// World points to pixels, also those that the camera does not see.
/// @param world a column of 3 doubles  @param pixels a column of 2, filled in place
void project_through_lens(const Camera& camera, const cv::Mat& world, cv::Mat& pixels);

/// Whether the lens can see a point in camera axes: it is before it, and not too far aside.
bool is_before_lens(const Camera& camera, const Eigen::Vector3d& point);

/// Pixels to rays, x/z and y/z in camera axes; not finite where there is none.
std::vector<cv::Point2d> rays_of(const Camera& camera, const std::vector<cv::Point2d>& pixels);

}  // namespace mcdbn
