#include "formats/opencv_storage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <iterator>
#include <sstream>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

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
  const bool list = found.isSeq();
  Values matrix{1, 1, {}};
  try {
    (list ? found : found["data"]) >> matrix.values;
    matrix.rows = list ? static_cast<int>(matrix.values.size()) : static_cast<int>(found["rows"]);
    if (!list) matrix.columns = static_cast<int>(found["cols"]);
  } catch (const std::exception&) {
    throw InputError(where(name) + " cannot be read; give an opencv-matrix");
  }
  // OpenCV would make room for as many as the file says before it counts them.
  const auto said = static_cast<std::int64_t>(matrix.rows) * matrix.columns;
  if (matrix.rows < 1 || said != std::ssize(matrix.values))
    throw InputError(where(name) + " is not a matrix of numbers; give an opencv-matrix");
  if (!std::ranges::all_of(matrix.values, [](double value) { return std::isfinite(value); }))
    throw InputError(where(name) + " holds a number that is not finite; correct it");
  return matrix;
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
    throw InputError(where(name) + " has not 3 numbers; give x y z in file units");
  return Eigen::Vector3d(found.values.data());
}

std::vector<std::string> OpencvStorage::strings(const std::string& name) const {
  std::vector<std::string> result;
  for (const cv::FileNode& entry : node(name)) {
    if (!entry.isString() && !entry.isInt())
      throw InputError(where(name) + " is not a list of names");
    result.push_back(entry.isString() ? entry.string() : std::to_string(static_cast<int>(entry)));
  }
  return result;
}

std::vector<std::string> OpencvStorage::keys() const {
  return storage_.root().isMap() ? storage_.root().keys() : std::vector<std::string>{};
}

}  // namespace mcdbn
