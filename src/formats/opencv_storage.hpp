#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn {

/// OpenCV's YAML, XML or JSON, whose errors name file and line. @throws InputError, as all here
class OpencvStorage {
 public:
  explicit OpencvStorage(const CameraSource& source);

  bool has(const std::string& name) const;
  double number(const std::string& name) const;
  /// A matrix, or a plain list of numbers, also row by row in lists: a column, or 3x3 if it has
  /// nine.
  struct Values {
    int rows, columns;
    std::vector<double> values;  ///< row by row, finite
  };
  Values matrix(const std::string& name) const;
  /// A 3x3 matrix. @param what it is to hold, for the error
  Eigen::Matrix3d square(const std::string& name, const std::string& what) const;
  Eigen::Vector3d point(const std::string& name) const;
  /// Keys of the top level.
  std::vector<std::string> keys() const;
  /// "file:line: name", the line of the file where the name stands.
  std::string where(const std::string& name) const;

 private:
  cv::FileNode node(const std::string& name) const;

  const CameraSource& source_;
  cv::FileStorage storage_;
};

}  // namespace mcdbn
