#include "formats/opencv_storage.hpp"

#include <fmt/format.h>

#include <exception>
#include <sstream>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// The count of numbers that an opencv-matrix declares, whatever their channels.
double stated_numbers(const cv::FileNode& matrix) {
  if (!matrix["rows"].empty())
    return static_cast<double>(matrix["rows"]) * static_cast<double>(matrix["cols"]);
  double numbers = 1;
  for (const cv::FileNode& size : matrix["sizes"]) numbers *= static_cast<double>(size);
  return numbers;
}

/// The numbers of a list, also of lists in it, one after the other. @return whether it holds no
/// more
bool add_numbers(const cv::FileNode& list, std::vector<double>& numbers) {
  for (const cv::FileNode& entry : list) {
    if (entry.isSeq()) {
      if (!add_numbers(entry, numbers)) return false;
    } else if (entry.isInt() || entry.isReal()) {
      numbers.push_back(entry.real());
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace

OpencvStorage::OpencvStorage(const CameraSource& source) : source_(source) {
  const auto fail = [&] {
    throw InputError(
        fmt::format("{}:1: not an OpenCV YAML, XML or JSON file; write it with cv::FileStorage",
                    source.path.string()));
  };
  try {
    storage_.open(source.text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  } catch (const std::exception&) {  // also of the standard library, for lengths
    fail();
  }
  if (!storage_.isOpened() || !storage_.root().isMap()) fail();
}

bool OpencvStorage::has(const std::string& name) const {
  return !storage_[name].empty();
}

std::string OpencvStorage::where(const std::string& name) const {
  std::istringstream lines(source_.text);
  std::string text;
  int line = 1;
  for (int number = 1; std::getline(lines, text); ++number) {
    const auto has = [&](const std::string& mark) { return text.find(mark) != text.npos; };
    if (!has(name + ":") && !has("<" + name) && !has('"' + name + '"')) continue;
    line = number;
    break;
  }
  return fmt::format("{}:{}: {}", source_.path.string(), line, name);
}

cv::FileNode OpencvStorage::node(const std::string& name) const {
  const cv::FileNode found = storage_[name];
  if (found.empty())
    throw InputError(fmt::format("{}:1: {} is missing; add it", source_.path.string(), name));
  return found;
}

double OpencvStorage::number(const std::string& name) const {
  const cv::FileNode found = node(name);
  if (!found.isInt() && !found.isReal())
    throw InputError(where(name) + " is not a whole number above 0; give one");
  return found.real();
}

OpencvStorage::Values OpencvStorage::matrix(const std::string& name) const {
  const cv::FileNode found = node(name);
  cv::Mat values;
  try {
    if (found.isSeq()) {
      std::vector<double> list;
      if (add_numbers(found, list)) {
        values = cv::Mat(list, true);
        if (list.size() == 9) values = values.reshape(1, 3);
      }
    } else if (!found.isMap() ||
               stated_numbers(found) <= static_cast<double>(found["data"].size())) {
      // Else OpenCV would make room for as many as the file declares before it counts them.
      found >> values;
    }
  } catch (const std::exception&) {
    throw InputError(where(name) + " cannot be read; give an opencv-matrix");
  }
  if (values.empty() || values.channels() != 1)
    throw InputError(where(name) + " is not a matrix of numbers; give an opencv-matrix");
  cv::Mat doubles;
  values.convertTo(doubles, CV_64F);
  if (!cv::checkRange(doubles))
    throw InputError(where(name) + " holds a number that is not finite; correct it");
  return {doubles.rows, doubles.cols, {doubles.begin<double>(), doubles.end<double>()}};
}

Eigen::Matrix3d OpencvStorage::square(const std::string& name, const std::string& what) const {
  const Values found = matrix(name);
  if (found.rows != 3 || found.columns != 3)
    throw InputError(fmt::format("{} is not 3x3; give {}", where(name), what));
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(found.values.data());
}

Eigen::Vector3d OpencvStorage::point(const std::string& name) const {
  const Values found = matrix(name);
  if (found.values.size() != 3)
    throw InputError(where(name) + " needs 3 numbers; give x y z in file units");
  return Eigen::Vector3d(found.values.data());
}

std::vector<std::string> OpencvStorage::keys() const {
  return storage_.root().isMap() ? storage_.root().keys() : std::vector<std::string>{};
}

}  // namespace mcdbn
