#include "base/safetensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/json_place.hpp"
#include "base/parsed_json.hpp"
#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

static_assert(std::endian::native == std::endian::little, "safetensors is little-endian");

constexpr std::size_t kLengthBytes = 8;

/// Where a tensor's numbers stand behind the header.
struct Extent {
  std::size_t begin, end;  ///< bytes
  std::string name;
};

/// Whether numbers of that shape take so many bytes. Divided, not multiplied: the product of a
/// wrong shape may be any number.
bool fills(const std::vector<std::size_t>& shape, std::size_t bytes, std::size_t number_bytes) {
  if (bytes % number_bytes != 0) return false;
  std::size_t left = bytes / number_bytes;
  if (std::ranges::count(shape, 0U) > 0) return left == 0;
  for (const std::size_t extent : shape) {
    if (left % extent != 0) return false;
    left /= extent;
  }
  return left == 1;
}

template <typename Number>
std::vector<float> numbers_in(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return {numbers.begin(), numbers.end()};
}

template <typename Number>
std::string bytes_of(const std::vector<float>& values) {
  const std::vector<Number> numbers(values.begin(), values.end());
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

Safetensors::Tensor read_tensor(const JsonPlace& entry, std::string_view data, Extent& extent) {
  const JsonPlace dtype = entry["dtype"];
  const bool half = dtype.text() == "F16";
  if (!half && dtype.text() != "F32")
    dtype.fail(fmt::format("{}; only F32 and F16 are read", shown(dtype.text())));
  const Range bytes = within(0, static_cast<double>(data.size()));
  const JsonPlace offsets = entry["data_offsets"];
  extent.begin = offsets.at(0).count(bytes);
  extent.end = offsets.at(1).count(bytes);
  if (offsets.size() != 2 || extent.begin > extent.end)
    offsets.fail("two numbers are wanted, the second not below the first");
  Safetensors::Tensor tensor;
  const JsonPlace shape = entry["shape"];
  for (const JsonPlace& length : shape.list()) tensor.shape.push_back(length.count(any_seed()));
  const std::string_view numbers = data.substr(extent.begin, extent.end - extent.begin);
  if (!fills(tensor.shape, numbers.size(), half ? sizeof(Eigen::half) : sizeof(float)))
    shape.fail("is not that of the numbers that are there");
  tensor.values = half ? numbers_in<Eigen::half>(numbers) : numbers_in<float>(numbers);
  return tensor;
}

/// Tensors follow each other without a hole, as the format wants it: nothing hides between them.
void check_places(std::vector<Extent> extents, std::size_t bytes, const std::string& file) {
  std::ranges::sort(extents, {}, [](const Extent& one) { return std::pair(one.begin, one.end); });
  std::size_t end = 0;
  for (const Extent& one : extents) {
    if (one.begin != end)
      throw InputError(fmt::format("{}: {}: its numbers {} those before them", file,
                                   shown(one.name),
                                   one.begin < end ? "overlap" : "leave a hole to"));
    end = one.end;
  }
  if (end != bytes)
    throw InputError(fmt::format("{}: {} bytes that belong to no tensor", file, bytes - end));
}

Safetensors parse(std::string_view bytes, const std::string& file) {
  std::uint64_t header_length = 0;
  if (bytes.size() < kLengthBytes)
    throw InputError(file + ": not a readable safetensors file: it is shorter than its header");
  std::memcpy(&header_length, bytes.data(), kLengthBytes);
  if (header_length > bytes.size() - kLengthBytes)
    throw InputError(file + ": not a readable safetensors file: it is shorter than its header");
  const auto header = parsed_json(bytes.substr(kLengthBytes, header_length));
  if (!header.is_object())
    throw InputError(file + ": not a readable safetensors file: its header is no JSON object");
  const std::string_view data = bytes.substr(kLengthBytes + header_length);
  const JsonPlace place(header, file);
  Safetensors content;
  std::vector<Extent> extents;
  for (const std::string& name : place.keys()) {
    if (name == "__metadata__") {
      for (const std::string& key : place[name].keys())
        content.metadata[key] = place[name][key].text();
    } else {
      extents.push_back({0, 0, name});
      content.tensors[name] = read_tensor(place[name], data, extents.back());
    }
  }
  check_places(std::move(extents), data.size(), file);
  return content;
}

}  // namespace

void Safetensors::put(const std::string& name, const MatrixF& values) {
  tensors[name] = {
      {static_cast<std::size_t>(values.rows()), static_cast<std::size_t>(values.cols())},
      {values.data(), values.data() + values.size()}};
}

MatrixF Safetensors::get(const std::string& name, const std::string& file, Eigen::Index rows,
                         Eigen::Index columns) const {
  const auto found = tensors.find(name);
  const std::vector<std::size_t> shape{static_cast<std::size_t>(rows),
                                       static_cast<std::size_t>(columns)};
  if (found == tensors.end() || found->second.shape != shape)
    throw InputError(fmt::format("{}: no tensor {} of {} x {}; train the model again", file, name,
                                 rows, columns));
  return Eigen::Map<const MatrixF>(found->second.values.data(), rows, columns);
}

void write_safetensors(const std::filesystem::path& path, const Safetensors& content) {
  nlohmann::ordered_json header;
  header["__metadata__"] = content.metadata;
  std::size_t offset = 0;
  for (const auto& [name, tensor] : content.tensors) {
    const std::size_t bytes =
        tensor.values.size() * (content.half ? sizeof(Eigen::half) : sizeof(float));
    header[name] = {{"dtype", content.half ? "F16" : "F32"},
                    {"shape", tensor.shape},
                    {"data_offsets", {offset, offset + bytes}}};
    offset += bytes;
  }
  std::string text = header.dump();
  text.append((kLengthBytes - text.size() % kLengthBytes) % kLengthBytes, ' ');  // aligned tensors
  const std::uint64_t length = text.size();
  std::string bytes(reinterpret_cast<const char*>(&length), kLengthBytes);
  bytes += text;
  for (const auto& [name, tensor] : content.tensors)
    bytes += content.half ? bytes_of<Eigen::half>(tensor.values) : bytes_of<float>(tensor.values);
  write_text_file(path, bytes);
}

Safetensors read_safetensors(const std::filesystem::path& path) {
  return parse(read_text_file(path), path.string());
}

}  // namespace mcdbn
