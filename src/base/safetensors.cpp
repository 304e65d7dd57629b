#include "base/safetensors.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

static_assert(std::endian::native == std::endian::little, "safetensors is little-endian");

constexpr std::size_t kLengthBytes = 8;

std::size_t element_count(const std::vector<std::size_t>& shape) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count *= extent;
  return count;
}

Safetensors::Tensor read_tensor(const nlohmann::json& entry, std::string_view data) {
  if (entry.at("dtype") != "F32") throw std::runtime_error("a tensor that is not F32");
  Safetensors::Tensor tensor;
  tensor.shape = entry.at("shape").get<std::vector<std::size_t>>();
  const auto [begin, end] = entry.at("data_offsets").get<std::pair<std::size_t, std::size_t>>();
  if (begin > end || end > data.size())
    throw std::runtime_error("a tensor that reaches past the file's end");
  if (end - begin != element_count(tensor.shape) * sizeof(float))
    throw std::runtime_error("a tensor whose size is not that of its shape");
  tensor.values.resize((end - begin) / sizeof(float));
  std::memcpy(tensor.values.data(), data.data() + begin, end - begin);
  return tensor;
}

Safetensors parse(std::string_view bytes) {
  std::uint64_t header_length = 0;
  if (bytes.size() < kLengthBytes) throw std::runtime_error("it is shorter than its header");
  std::memcpy(&header_length, bytes.data(), kLengthBytes);
  if (header_length > bytes.size() - kLengthBytes)
    throw std::runtime_error("it is shorter than its header");
  const auto header = nlohmann::json::parse(bytes.substr(kLengthBytes, header_length));
  const std::string_view data = bytes.substr(kLengthBytes + header_length);
  Safetensors content;
  for (const auto& [name, entry] : header.items()) {
    if (name == "__metadata__")
      content.metadata = entry.get<std::map<std::string, std::string>>();
    else
      content.tensors[name] = read_tensor(entry, data);
  }
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
    const std::size_t bytes = tensor.values.size() * sizeof(float);
    header[name] = {
        {"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {offset, offset + bytes}}};
    offset += bytes;
  }
  std::string text = header.dump();
  text.append((kLengthBytes - text.size() % kLengthBytes) % kLengthBytes, ' ');  // aligned tensors
  const std::uint64_t length = text.size();
  std::string bytes(reinterpret_cast<const char*>(&length), kLengthBytes);
  bytes += text;
  for (const auto& [name, tensor] : content.tensors)
    bytes.append(reinterpret_cast<const char*>(tensor.values.data()),
                 tensor.values.size() * sizeof(float));
  write_text_file(path, bytes);
}

Safetensors read_safetensors(const std::filesystem::path& path) {
  const std::string bytes = read_text_file(path);
  try {
    return parse(bytes);
  } catch (const std::exception& error) {
    throw InputError(
        fmt::format("{}: not a readable safetensors file: {}", path.string(), error.what()));
  }
}

}  // namespace mcdbn
