#include "mcdbn/formats/camera_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/eigen.hpp>
#include <string>
#include <string_view>

#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

class CameraReader {
 public:
  explicit CameraReader(const std::filesystem::path& path) : path_(path) {
    // OpenCV would print to stderr by itself.
    if (!std::filesystem::is_regular_file(path) || !std::ifstream(path)) {
      throw InputError(fmt::format("{}: cannot be read; check the path", path.string()));
    }
    try {
      storage_.open(path.string(), cv::FileStorage::READ);
    } catch (const cv::Exception& error) {
      fail(1, fmt::format("not an OpenCV YAML, XML or JSON file ({}); write it with "
                          "cv::FileStorage",
                          error.err));
    }
    if (!storage_.isOpened()) fail(1, "not an OpenCV YAML, XML or JSON file");
  }

  Camera read() {
    Camera camera;
    camera.width_px = size_px("image_width");
    camera.height_px = size_px("image_height");
    const cv::Mat intrinsics = matrix("camera_matrix");
    if (intrinsics.rows != 3 || intrinsics.cols != 3) {
      fail_at("camera_matrix", "is not 3x3; give [fx 0 cx; 0 fy cy; 0 0 1]");
    }
    camera.fx_px = intrinsics.at<double>(0, 0);
    camera.fy_px = intrinsics.at<double>(1, 1);
    camera.cx_px = intrinsics.at<double>(0, 2);
    camera.cy_px = intrinsics.at<double>(1, 2);
    if (!(camera.fx_px > 0 && camera.fy_px > 0)) {
      fail_at("camera_matrix", "has no focal length above 0; give fx and fy in pixels");
    }
    camera.distortion = distortion();
    camera.camera_from_world = rotation();
    const cv::Mat translation = matrix("tvec");
    if (translation.total() != 3) fail_at("tvec", "has not 3 numbers; give x y z in file units");
    const auto* xyz = translation.ptr<double>();
    camera.translation = {xyz[0], xyz[1], xyz[2]};
    return camera;
  }

 private:
  [[noreturn]] void fail(int line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_.string(), line, what));
  }

  /// Names the line where the file speaks of `node`.
  [[noreturn]] void fail_at(const std::string& node, const std::string& what) const {
    std::ifstream file(path_);
    std::string text;
    int line = 1;
    for (int number = 1; std::getline(file, text); ++number) {
      const auto has = [&](const std::string& mark) { return text.find(mark) != text.npos; };
      if (!has(node + ":") && !has("<" + node) && !has('"' + node + '"')) continue;
      line = number;
      break;
    }
    fail(line, node + " " + what);
  }

  cv::FileNode node(const std::string& name) const {
    const cv::FileNode found = storage_[name];
    if (found.empty()) fail(1, fmt::format("{} is missing; add it", name));
    return found;
  }

  int size_px(const std::string& name) const {
    const cv::FileNode found = node(name);
    const double value = found.isInt() || found.isReal() ? found.real() : 0;
    if (!(value >= 1 && value <= 1e6 && value == std::floor(value))) {
      fail_at(name, "is not a whole number above 0; give the image's size in pixels");
    }
    return static_cast<int>(value);
  }

  /// A matrix, or a plain list of numbers, as doubles in one block.
  cv::Mat matrix(const std::string& name) const {
    const cv::FileNode found = node(name);
    cv::Mat values;
    try {
      if (found.isSeq()) {
        std::vector<double> list;
        found >> list;
        values = cv::Mat(list, true);
      } else {
        found >> values;
      }
    } catch (const cv::Exception& error) {
      fail_at(name, fmt::format("cannot be read ({}); give an opencv-matrix", error.err));
    }
    if (values.empty() || values.channels() != 1) {
      fail_at(name, "is not a matrix of numbers; give an opencv-matrix");
    }
    cv::Mat doubles;
    values.convertTo(doubles, CV_64F);
    if (!cv::checkRange(doubles)) fail_at(name, "holds a number that is not finite; correct it");
    return doubles;
  }

  std::vector<double> distortion() const {
    constexpr const char* kName = "distortion_coefficients";
    if (storage_[kName].empty()) return {};
    const cv::Mat values = matrix(kName);
    constexpr std::size_t kCounts[] = {4, 5, 8, 12, 14};
    if (std::find(std::begin(kCounts), std::end(kCounts), values.total()) == std::end(kCounts)) {
      fail_at(kName, fmt::format("has {} numbers; OpenCV knows 4, 5, 8, 12 or 14", values.total()));
    }
    return {values.begin<double>(), values.end<double>()};
  }

  Eigen::Matrix3d rotation() const {
    cv::Mat values;
    std::string name = "R";
    if (!storage_["rvec"].empty()) {
      name = "rvec";
      const cv::Mat vector = matrix(name);
      if (vector.total() != 3) fail_at(name, "has not 3 numbers; give a rotation vector");
      cv::Rodrigues(vector, values);
    } else {
      if (storage_[name].empty()) fail(1, "neither rvec nor R is there; add the camera's rotation");
      values = matrix(name);
      if (values.rows != 3 || values.cols != 3) fail_at(name, "is not 3x3; give a rotation matrix");
    }
    Eigen::Matrix3d result;
    cv::cv2eigen(values, result);
    constexpr double kRounding = 1e-3;  // what people print with three decimals still passes
    if ((result * result.transpose() - Eigen::Matrix3d::Identity()).norm() > kRounding ||
        result.determinant() < 0) {
      fail_at(name, "is not a rotation; its rows must be orthonormal and right-handed");
    }
    return result;
  }

  std::filesystem::path path_;
  cv::FileStorage storage_;
};

}  // namespace

Camera read_camera(const std::filesystem::path& path) {
  return CameraReader(path).read();
}

void write_camera(const std::filesystem::path& path, const Camera& camera) {
  const std::string extension = path.extension().string();
  constexpr std::string_view kFormats[] = {".yml", ".yaml", ".xml", ".json"};
  if (std::find(std::begin(kFormats), std::end(kFormats), extension) == std::end(kFormats)) {
    throw InputError(
        fmt::format("{}: no camera format has the ending '{}'; use .yml, .xml or .json",
                    path.string(), extension));
  }
  std::string text;
  try {
    // In memory the name only chooses the format.
    cv::FileStorage storage("camera" + extension, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    cv::Mat rotation;
    cv::eigen2cv(camera.camera_from_world, rotation);
    storage << "image_width" << camera.width_px << "image_height" << camera.height_px;
    storage << "camera_matrix"
            << cv::Mat(cv::Matx33d(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0,
                                   0, 1));
    if (!camera.distortion.empty()) {
      storage << "distortion_coefficients" << cv::Mat(camera.distortion);
    }
    storage << "R" << rotation << "tvec"
            << cv::Mat(cv::Vec3d(camera.translation.x(), camera.translation.y(),
                                 camera.translation.z()));
    text = storage.releaseAndGetString();
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: cannot be written ({})", path.string(), error.err));
  }
  write_text_file(path, text);
}

}  // namespace mcdbn
