#include "mcdbn/device/parameters.hpp"

#include <algorithm>

#include "device/opencl_errors.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// A checkpoint is the same on every device that needs no more than this, as most do.
constexpr std::size_t kUsualAlignmentBits = 4096;

/// Floats at whose multiples a part of a buffer may begin (CL_DEVICE_MEM_BASE_ADDR_ALIGN).
std::size_t alignment_floats(const Device& device) {
  const auto bits = checked(device.info().name, "asking for its alignment", [&] {
    return device.queue().getInfo<CL_QUEUE_DEVICE>().getInfo<CL_DEVICE_MEM_BASE_ADDR_ALIGN>();
  });
  return std::max<std::size_t>(bits, kUsualAlignmentBits) / 8 / sizeof(float);
}

std::size_t rounded_up(std::size_t value, std::size_t to) {
  return (value + to - 1) / to * to;
}

using Index = Eigen::Index;

/// [rows x n] → [device_rows x n]: each frame's rows followed by rows of zeros.
MatrixF with_frame_padding(const MatrixF& values, const ParameterShape& shape) {
  if (shape.frame_rows == 0) return values;
  const auto rows = static_cast<Index>(shape.frame_rows);
  const auto stride = static_cast<Index>(padded(shape.frame_rows));
  MatrixF wide = MatrixF::Zero(static_cast<Index>(shape.device_rows()), values.cols());
  for (Index frame = 0; frame * rows < values.rows(); ++frame)
    wide.middleRows(frame * stride, rows) = values.middleRows(frame * rows, rows);
  return wide;
}

MatrixF without_frame_padding(const MatrixF& wide, const ParameterShape& shape) {
  if (shape.frame_rows == 0) return wide;
  const auto rows = static_cast<Index>(shape.frame_rows);
  const auto stride = static_cast<Index>(padded(shape.frame_rows));
  MatrixF values(static_cast<Index>(shape.rows), wide.cols());
  for (Index frame = 0; frame * rows < values.rows(); ++frame)
    values.middleRows(frame * rows, rows) = wide.middleRows(frame * stride, rows);
  return values;
}

}  // namespace

Parameters::Parameters(Device& device, const std::vector<ParameterShape>& shapes) {
  const std::size_t alignment = alignment_floats(device);
  std::size_t floats = 0;
  for (const ParameterShape& shape : shapes) {
    if (std::any_of(entries_.begin(), entries_.end(),
                    [&](const Entry& entry) { return entry.name == shape.name; }))
      throw ShapeError("parameters: two are called " + shape.name);
    entries_.push_back({shape, floats});
    floats = rounded_up(floats + shape.floats(), alignment);
  }
  values_ = Matrix(device, 1, floats);
}

Parameters Parameters::part(std::string_view prefix) const {
  std::vector<Entry> entries;
  for (Entry entry : entries_) {
    if (!entry.name.starts_with(prefix)) continue;
    entry.name.erase(0, prefix.size());
    entries.push_back(std::move(entry));
  }
  return {values_, std::move(entries)};
}

const Parameters::Entry& Parameters::entry(std::string_view name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.name == name; });
  if (found == entries_.end()) throw ShapeError("parameters: none is called " + std::string(name));
  return *found;
}

Matrix Parameters::matrix(std::string_view name) const {
  const Entry& shape = entry(name);
  return values_.part(shape.first, shape.device_rows(), shape.columns);
}

Parameters Parameters::in(const Matrix& buffer) const {
  if (buffer.rows() != 1 || buffer.columns() != values_.columns())
    throw ShapeError("parameters: the buffer has another size");
  return {buffer, entries_};
}

MatrixF Parameters::to_host(std::string_view name) const {
  return without_frame_padding(matrix(name).to_host(), entry(name));
}

void Parameters::upload(std::string_view name, const MatrixF& values) {
  const Entry& shape = entry(name);
  if (static_cast<std::size_t>(values.rows()) != shape.rows ||
      static_cast<std::size_t>(values.cols()) != shape.columns)
    throw ShapeError("parameters: " + std::string(name) + " has another shape");
  matrix(name).upload(with_frame_padding(values, shape));
}

}  // namespace mcdbn
