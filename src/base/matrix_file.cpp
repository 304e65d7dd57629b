#include "mcdbn/base/matrix_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <sstream>
#include <vector>

#include "base/interruption.hpp"
#include "base/lower_extension.hpp"
#include "base/npy.hpp"
#include "base/safetensors.hpp"
#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSpace = " \t\r";

[[noreturn]] void fail_on_extension(const fs::path& path) {
  throw InputError(fmt::format("{}: unknown kind of file; give a .npy, a .csv or a .safetensors",
                               path.string()));
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

/// The number that the whole cell is; NaN where it is empty, also between quotes.
std::optional<float> number(std::string_view cell) {
  if (cell.empty() || cell == "\"\"") return std::numeric_limits<float>::quiet_NaN();
  if (cell.front() == '+') cell.remove_prefix(1);
  double value = 0;  // so that what is too small for a float is 0, not an error
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return {};
  return static_cast<float>(value);
}

class CsvReader {
 public:
  explicit CsvReader(std::string name) : name_(std::move(name)) {}

  MatrixF read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    for (std::size_t line = 1; !text.empty(); ++line) {
      check_interruption();
      const auto end = std::min(text.find('\n'), text.size());
      add_line(trimmed(text.substr(0, end)), line);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (columns_ == 1 && empty_ > 0) {
      --empty_;  // the last line of the file is none
      add_unknown_rows();
    }
    return Eigen::Map<const MatrixF>(values_.data(), rows_, columns_);
  }

 private:
  void add_line(std::string_view text, std::size_t line) {
    if (text.empty()) {
      ++empty_;
      return;
    }
    const bool is_first = !seen_;
    seen_ = true;
    if (is_first && is_header(text)) {
      empty_ = 0;
      return;
    }
    row_.clear();
    for_each_cell(text, [&](std::string_view cell) {
      const std::optional<float> value = number(cell);
      if (!value)
        throw InputError(fmt::format("{}:{}: {} in column {} is no number", name_, line,
                                     shown(cell), row_.size() + 1));
      row_.push_back(*value);
    });
    if (columns_ == 0) columns_ = std::ssize(row_);
    if (std::ssize(row_) != columns_)
      throw InputError(fmt::format("{}:{}: {} columns, {} in the lines before it", name_, line,
                                   row_.size(), columns_));
    if (columns_ == 1) add_unknown_rows();
    empty_ = 0;
    values_.insert(values_.end(), row_.begin(), row_.end());
    ++rows_;
  }

  /// Adds the empty lines of a file of one column, where each is an empty cell.
  void add_unknown_rows() {
    values_.insert(values_.end(), empty_, std::numeric_limits<float>::quiet_NaN());
    rows_ += static_cast<Eigen::Index>(empty_);
  }

  template <typename Visit>
  static void for_each_cell(std::string_view text, const Visit& visit) {
    for (;;) {
      const auto comma = text.find(',');
      visit(trimmed(text.substr(0, comma)));
      if (comma == std::string_view::npos) return;
      text.remove_prefix(comma + 1);
    }
  }

  /// Words and no number. A word among numbers is no column's name: the line would be lost.
  static bool is_header(std::string_view text) {
    bool words = false, numbers = false;
    for_each_cell(text, [&](std::string_view cell) {
      const std::optional<float> value = number(cell);
      words = words || !value;
      numbers = numbers || (value && !std::isnan(*value));
    });
    return words && !numbers;
  }

  std::string name_;
  std::vector<float> values_, row_;
  Eigen::Index rows_ = 0, columns_ = 0;
  std::size_t empty_ = 0;  ///< empty lines before this one
  bool seen_ = false;      ///< a header or a line of numbers
};

MatrixF matrix_of(const Safetensors& content, const std::string& file, const std::string& tensor) {
  if (tensor.empty() && content.tensors.size() != 1)
    throw InputError(
        fmt::format("{}: {} tensors; give the name of one", file, content.tensors.size()));
  const auto found = tensor.empty() ? content.tensors.begin() : content.tensors.find(tensor);
  if (found == content.tensors.end())
    throw InputError(fmt::format("{}: no tensor {}", file, tensor));
  std::vector<std::size_t> shape = found->second.shape;
  if (shape.size() == 1) shape.push_back(1);
  if (shape.size() != 2)
    throw InputError(fmt::format("{}: tensor {} has {} dimensions; 2 are wanted", file,
                                 found->first, shape.size()));
  if (shape[1] == 0 && shape[0] > 0)
    throw InputError(
        fmt::format("{}: tensor {} has {} rows without columns", file, found->first, shape[0]));
  return Eigen::Map<const MatrixF>(found->second.values.data(), static_cast<Eigen::Index>(shape[0]),
                                   static_cast<Eigen::Index>(shape[1]));
}

enum class Kind { npy, csv, safetensors };

std::optional<Kind> matrix_kind(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".npy") return Kind::npy;
  if (extension == ".csv") return Kind::csv;
  if (extension == ".safetensors") return Kind::safetensors;
  return {};
}

MatrixF read_npy(const fs::path& path) {
  const std::string bytes = read_text_file(path);
  try {
    return npy_matrix(bytes);
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("{}: not a readable .npy file: {}", path.string(), error.what()));
  }
}

MatrixF matrix_in(const fs::path& path, const std::string& tensor) {
  const auto kind = matrix_kind(path);
  if (kind == Kind::npy) return read_npy(path);
  if (kind == Kind::csv) return CsvReader(path.string()).read(read_text_file(path));
  if (kind == Kind::safetensors) return matrix_of(read_safetensors(path), path.string(), tensor);
  fail_on_extension(path);
}

}  // namespace

bool is_matrix_file(const fs::path& path) {
  return matrix_kind(path).has_value();
}

MatrixF read_matrix(const fs::path& path, const std::string& tensor) {
  MatrixF values = matrix_in(path, tensor);
  if (values.size() == 0) throw InputError(fmt::format("{}: no numbers", path.string()));
  return values;
}

void write_csv(std::ostream& stream, const MatrixF& values) {
  std::string line;
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    check_interruption();
    line.clear();
    for (Eigen::Index c = 0; c < values.cols(); ++c)
      fmt::format_to(std::back_inserter(line), "{}{}", c == 0 ? "" : ",", values(r, c));
    stream << line << '\n';
  }
}

void write_matrix(const fs::path& path, const MatrixF& values, const std::string& tensor) {
  const auto kind = matrix_kind(path);
  if (kind == Kind::npy) {
    write_text_file(path, npy_bytes(values));
  } else if (kind == Kind::csv) {
    std::ostringstream text;
    write_csv(text, values);
    write_text_file(path, text.str());
  } else if (kind == Kind::safetensors) {
    Safetensors content;
    content.put(tensor, values);
    write_safetensors(path, content);
  } else {
    fail_on_extension(path);
  }
}

}  // namespace mcdbn
