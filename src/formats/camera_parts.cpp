#include "formats/camera_parts.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "mcdbn/base/errors.hpp"
#include "motion/nearest_rotation.hpp"

namespace mcdbn {

namespace {

/// A control character: OpenCV's XML reader takes the program down with it.
bool is_no_text(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f') || byte == 0x7F;
}

}  // namespace

void check_camera_source(const CameraSource& source) {
  /// Parsers call themselves for what is nested: a file that only nests would bring them down.
  constexpr int kDeepest = 32, kWidestIndent = 64;
  int line = 1, brackets = 0, tags = 0, indent = 0;
  bool at_start = true;
  const std::string& text = source.text;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
    if (is_no_text(c))
      throw InputError(fmt::format("{}:{}: a byte that no text holds", source.path.string(), line));
    if (c == '[' || c == '{') ++brackets;
    if ((c == ']' || c == '}') && brackets > 0) --brackets;
    if (c == '<' && next == '/') tags -= tags > 0;
    if (c == '<' && (std::isalpha(static_cast<unsigned char>(next)) || next == '_')) ++tags;
    if (c == '/' && next == '>') tags -= tags > 0;
    at_start = c == '\n' || (at_start && (c == ' ' || c == '-' || c == '?' || c == ':'));
    indent = at_start && c != '\n' && brackets == 0 && tags == 0 ? indent + 1 : 0;
    if (brackets > kDeepest || tags > kDeepest || indent > kWidestIndent)
      throw InputError(
          fmt::format("{}:{}: nested deeper than any camera file", source.path.string(), line));
    line += c == '\n';
  }
}

std::string place_of(const std::filesystem::path& path, const std::string& text,
                     const std::string& mark) {
  const auto at = text.find(mark);
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(at == text.npos ? 0 : at);
  return fmt::format("{}:{}: ", path.string(), 1 + std::count(text.begin(), end, '\n'));
}

void set_intrinsics(Camera& camera, const Eigen::Matrix3d& matrix, const std::string& where) {
  camera.fx_px = matrix(0, 0);
  camera.fy_px = matrix(1, 1);
  camera.cx_px = matrix(0, 2);
  camera.cy_px = matrix(1, 2);
  if (!matrix.allFinite())
    throw InputError(where + " holds a number that is not finite; correct it");
  if (!(camera.fx_px > 0 && camera.fy_px > 0))
    throw InputError(where + " has no focal length above 0; give fx and fy in pixels");
}

void set_distortion(Camera& camera, std::vector<double> values, const std::string& where) {
  constexpr std::size_t kCounts[] = {0, 4, 5, 8, 12, 14};
  if (std::ranges::find(kCounts, values.size()) == std::end(kCounts))
    throw InputError(
        fmt::format("{} has {} numbers; OpenCV knows 4, 5, 8, 12 or 14", where, values.size()));
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw InputError(where + " holds a number that is not finite; correct it");
  camera.distortion = std::move(values);
}

void set_fisheye(Camera& camera, std::vector<double> values, const std::string& where) {
  if (!values.empty() && values.size() != 4)
    throw InputError(fmt::format("{} has {} numbers; a fisheye has 4", where, values.size()));
  set_distortion(camera, std::move(values), where);
  camera.fisheye = true;
}

int pixels_of(double value, const std::string& where) {
  if (!Camera::kImage_px.contains(value) || value != std::floor(value))
    throw InputError(where + " is not a whole number above 0; give the image's size in pixels");
  return static_cast<int>(value);
}

void guess_size(Camera& camera) {
  const auto around = [](double centre_px) {
    const Range range = Camera::kImage_px;
    return static_cast<int>(std::lround(std::clamp(2 * centre_px, range.least, range.most)));
  };
  camera.width_px = around(camera.cx_px);
  camera.height_px = around(camera.cy_px);
  camera.size_is_guess = true;
}

Eigen::Matrix3d rotation_of(const std::vector<double>& values, const std::string& where) {
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw InputError(where + " holds a number that is not finite; correct it");
  Eigen::Matrix3d result;
  if (values.size() == 3) {
    cv::Mat matrix;
    cv::Rodrigues(cv::Vec3d(values[0], values[1], values[2]), matrix);
    cv::cv2eigen(matrix, result);
  } else if (values.size() == 9) {
    result = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
  } else {
    throw InputError(where + " is not 3x3 nor a rotation vector; give one of them");
  }
  constexpr double kRounding = 1e-3;  // what people print with three decimals still passes
  constexpr double kExact = 1e-12;
  const double off = (result * result.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(off <= kRounding) || result.determinant() < 0)
    throw InputError(where + " is not a rotation; its rows must be orthonormal and right-handed");
  // OpenCV projects by the nearest rotation, and rays have to be those of what is projected.
  return off > kExact ? nearest_rotation(result) : result;
}

void set_pose(Camera& camera, const Eigen::Matrix3d& camera_from_world,
              const Eigen::Vector3d& translation, WorldUp up) {
  Eigen::Matrix3d theirs_from_ours = Eigen::Matrix3d::Identity();
  if (up == WorldUp::z) theirs_from_ours << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == WorldUp::minus_y) theirs_from_ours.diagonal() << 1, -1, -1;
  camera.camera_from_world = camera_from_world * theirs_from_ours;
  camera.translation = translation;
}

}  // namespace mcdbn
