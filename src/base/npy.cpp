#include "base/npy.hpp"
#include "base/shown.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace mcdbn {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they are stored");

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::string_view kHeaderSpace = " \t\n";
constexpr std::size_t kAlignment = 64;  // of the data, header included

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what);
}

/// What follows `'key':` in the header, a Python dictionary.
std::string_view value_of(std::string_view header, std::string_view key) {
  const auto found = header.find(fmt::format("'{}'", key));
  const auto colon = found == std::string_view::npos ? found : header.find(':', found);
  if (colon == std::string_view::npos) fail(fmt::format("its header has no '{}'", key));
  header.remove_prefix(colon + 1);
  const auto first = header.find_first_not_of(kHeaderSpace);
  return first == std::string_view::npos ? std::string_view() : header.substr(first);
}

std::string text_of(std::string_view header, std::string_view key) {
  const std::string_view value = value_of(header, key);
  const auto end = value.empty() ? std::string_view::npos : value.find(value.front(), 1);
  if (end == std::string_view::npos || (value.front() != '\'' && value.front() != '"'))
    fail(fmt::format("its '{}' is no text: records are not read, only numbers", key));
  return std::string(value.substr(1, end - 1));
}

bool truth_of(std::string_view header, std::string_view key) {
  const std::string_view value = value_of(header, key);
  if (value.starts_with("True")) return true;
  if (!value.starts_with("False")) fail(fmt::format("its '{}' is neither True nor False", key));
  return false;
}

/// (3, 4) or (3,)
std::vector<std::size_t> shape_of(std::string_view header) {
  std::string_view value = value_of(header, "shape");
  const auto end = value.find(')');
  if (!value.starts_with('(') || end == std::string_view::npos) fail("its 'shape' is no tuple");
  value = value.substr(1, end - 1);
  std::vector<std::size_t> shape;
  while (true) {
    const auto first = value.find_first_not_of(" ,");
    if (first == std::string_view::npos) return shape;
    value.remove_prefix(first);
    std::size_t extent = 0;
    const auto [rest, error] = std::from_chars(value.data(), value.data() + value.size(), extent);
    if (error != std::errc()) fail("its 'shape' is not of whole numbers");
    shape.push_back(extent);
    value.remove_prefix(static_cast<std::size_t>(rest - value.data()));
  }
}

template <typename Stored>
double number_at(const char* data, std::size_t index) {
  Stored value;
  std::memcpy(&value, data + index * sizeof(Stored), sizeof(Stored));
  return static_cast<double>(value);
}

struct NumberType {
  std::string_view name;
  std::size_t bytes;
  double (*read)(const char* data, std::size_t index);
};

template <typename Stored>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(Stored), number_at<Stored>};
}

constexpr std::array kNumberTypes{
    number_type<float>("<f4"),         number_type<double>("<f8"),
    number_type<std::uint8_t>("|b1"),  number_type<std::int8_t>("|i1"),
    number_type<std::uint8_t>("|u1"),  number_type<std::int16_t>("<i2"),
    number_type<std::uint16_t>("<u2"), number_type<std::int32_t>("<i4"),
    number_type<std::uint32_t>("<u4"), number_type<std::int64_t>("<i8"),
    number_type<std::uint64_t>("<u8"),
};

const NumberType& number_type_of(const std::string& name) {
  for (const NumberType& type : kNumberTypes)
    if (type.name == name) return type;
  fail(fmt::format(
      "numbers of type {}; read are floats of 32 and 64 bits, whole numbers and truth values, "
      "little endian",
      shown(name)));
}

struct Parts {
  std::string_view header, data;
};

Parts split(std::string_view bytes) {
  constexpr std::size_t kVersionAt = kMagic.size(), kLengthAt = kVersionAt + 2;
  if (!bytes.starts_with(kMagic)) fail("it does not begin as a .npy file does");
  if (bytes.size() < kLengthAt + 4) fail("it is shorter than its header");
  const auto version = static_cast<unsigned char>(bytes[kVersionAt]);
  if (version < 1 || version > 3) fail(fmt::format("version {} of the format", version));
  // Two bytes of length in version 1, four in those after it.
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + kLengthAt, length_bytes);
  bytes.remove_prefix(kLengthAt + length_bytes);
  if (length > bytes.size()) fail("it is shorter than its header");
  return {bytes.substr(0, length), bytes.substr(length)};
}

struct StoredArray {
  const NumberType& type;
  bool by_columns;
  std::vector<std::size_t> shape;
  std::string_view data;
};

StoredArray stored_in(std::string_view bytes) {
  const auto [header, data] = split(bytes);
  StoredArray stored{number_type_of(text_of(header, "descr")), truth_of(header, "fortran_order"),
                     shape_of(header), data};
  // Divided, not multiplied: the product of a wrong shape may be any number.
  std::size_t left = data.size() / stored.type.bytes;
  bool fits = data.size() % stored.type.bytes == 0, none = false;
  for (const std::size_t extent : stored.shape) {
    none = none || extent == 0;
    fits = fits && (none || left % extent == 0);
    if (fits && !none) left /= extent;
  }
  if (none ? !data.empty() : !fits || left != 1)
    fail(fmt::format("{} bytes of numbers, not {} of type '{}'", data.size(),
                     fmt::join(stored.shape, " x "), stored.type.name));
  return stored;
}

std::string bytes_of(std::string_view type, const std::vector<std::size_t>& shape,
                     std::string_view data) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}",
                                   type, fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t before = kMagic.size() + 4;  // version and length
  const std::size_t unpadded = before + header.size() + 1;
  header.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string bytes(kMagic);
  bytes += std::string_view("\x01\x00", 2);
  bytes.append(reinterpret_cast<const char*>(&length), sizeof(length));
  bytes += header;
  return bytes.append(data);
}

}  // namespace

NpyArray npy_array(std::string_view bytes) {
  const StoredArray stored = stored_in(bytes);
  NpyArray array{stored.shape, {}};
  std::vector<std::size_t> at(array.shape.size());
  const std::size_t count =
      std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>());
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t index = i;
    if (stored.by_columns) {
      index = 0;
      for (std::size_t d = at.size(); d-- > 0;) index = index * array.shape[d] + at[d];
    }
    array.values.push_back(stored.type.read(stored.data.data(), index));
    for (std::size_t d = at.size(); d-- > 0 && ++at[d] == array.shape[d];) at[d] = 0;
  }
  return array;
}

std::string npy_bytes(const NpyArray& array) {
  return bytes_of(
      "<f8", array.shape,
      {reinterpret_cast<const char*>(array.values.data()), array.values.size() * sizeof(double)});
}

MatrixF npy_matrix(std::string_view bytes) {
  const StoredArray stored = stored_in(bytes);
  const std::vector<std::size_t>& shape = stored.shape;
  if (shape.empty() || shape.size() > 2)
    fail(fmt::format("{} dimensions; 2 are wanted", shape.size()));
  const std::size_t rows = shape[0], columns = shape.size() == 1 ? 1 : shape[1];
  // Nothing in the file bounds their number.
  if (columns == 0 && rows > 0) fail(fmt::format("{} rows without columns", rows));
  MatrixF values(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c)
      values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = static_cast<float>(
          stored.type.read(stored.data.data(), stored.by_columns ? c * rows + r : r * columns + c));
  return values;
}

std::string npy_bytes(const MatrixF& values) {
  return bytes_of(
      "<f4", {static_cast<std::size_t>(values.rows()), static_cast<std::size_t>(values.cols())},
      {reinterpret_cast<const char*>(values.data()),
       static_cast<std::size_t>(values.size()) * sizeof(float)});
}

}  // namespace mcdbn
