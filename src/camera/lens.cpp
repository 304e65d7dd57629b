#include "camera/lens.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "base/numbers.hpp"

namespace mcdbn {
namespace {

/// Bound of the length of a ray (x/z, y/z): one 84 degrees aside. Further out it grows without end.
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

/// A ray of length r becomes one of length r·N(r²)/D(r²), N and D the polynomials of OpenCV's k1,
/// k2, k3 and k4, k5, k6.
class RadialDistortion {
 public:
  /// @param values k1 k2 p1 p2 [k3 [k4 k5 k6 …]]; may be empty
  explicit RadialDistortion(const std::vector<double>& values) {
    constexpr std::array<std::size_t, 6> kPlaces{0, 1, 4, 5, 6, 7};
    for (std::size_t i = 0; i < kPlaces.size(); ++i)
      if (kPlaces[i] < values.size()) k_[i] = values[kPlaces[i]];
  }

  bool is_none() const {
    return std::ranges::all_of(k_, [](double k) { return k == 0; });
  }

  /// Whether a ray a little longer becomes longer, too.
  bool grows(double r) const {
    const double s = r * r;
    const auto polynomial = [s](double first, double second, double third) {
      return s * (first + s * (second + s * third));
    };
    const double numerator = 1 + polynomial(k_[0], k_[1], k_[2]),
                 denominator = 1 + polynomial(k_[3], k_[4], k_[5]);
    // The derivative by r, times the denominator's square.
    const double slope = (numerator + 2 * polynomial(k_[0], 2 * k_[1], 3 * k_[2])) * denominator -
                         numerator * 2 * polynomial(k_[3], 2 * k_[4], 3 * k_[5]);
    return denominator > 0 && slope > 0;
  }

 private:
  std::array<double, 6> k_{};
};

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

double steepest_ray(const Camera& camera) {
  if (camera.fisheye) return kSteepest;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const RadialDistortion distortion(camera.distortion);
  if (distortion.is_none()) return kInfinity;
  constexpr int kSteps = 900;  // of a tenth of a degree
  const auto ray = [](int step) { return std::tan(step * EIGEN_PI / 2 / kSteps); };
  for (int step = 1; step < kSteps; ++step) {
    if (distortion.grows(ray(step))) continue;
    double grows = ray(step - 1), turned = ray(step);
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = (grows + turned) / 2;
      (distortion.grows(middle) ? grows : turned) = middle;
    }
    return grows;
  }
  return kInfinity;
}

bool is_before_lens(const Eigen::Vector3d& point, double steepest) {
  return point.z() > 0 && point.head<2>().norm() < steepest * point.z();
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
