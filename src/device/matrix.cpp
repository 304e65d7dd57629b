#include "mcdbn/device/matrix.hpp"

#include <fmt/format.h>

#include <limits>

#include "device/opencl_errors.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

bool is_lack_of_memory(cl_int code) {
  return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES ||
         code == CL_OUT_OF_HOST_MEMORY || code == CL_INVALID_BUFFER_SIZE;
}

/// Why there is no room for so many bytes: the largest buffer that the device takes, or its memory.
std::string no_room(const DeviceInfo& device, std::size_t bytes) {
  constexpr double kMegabyte = 1e6;
  constexpr const char* kLess = "smaller layers and mini-batches need less";
  const double wanted = static_cast<double>(bytes) / kMegabyte,
               has = static_cast<double>(device.global_memory_bytes) / kMegabyte;
  if (bytes > device.largest_buffer_bytes)
    return fmt::format(
        "{}: no room for {:.3g} MB in one buffer, it takes {:.0f} MB at most, of {:.0f} MB that it "
        "has; {}",
        device.name, wanted, static_cast<double>(device.largest_buffer_bytes) / kMegabyte, has,
        kLess);
  return fmt::format("{}: no room for {:.3g} MB more, of {:.0f} MB that it has; {}", device.name,
                     wanted, has, kLess);
}

/// @throws DeviceError with the size wanted where the device has no room for it
cl::Buffer allocate(const Device& device, std::size_t bytes) {
  try {
    return {device.context(), CL_MEM_READ_WRITE, bytes};
  } catch (const cl::Error& error) {
    if (!is_lack_of_memory(error.err()))
      throw device_error(device.info().name, "allocating a matrix", error);
    throw DeviceError(no_room(device.info(), bytes), DeviceError::Kind::refused);
  }
}

void require_shape(bool holds, const char* what) {
  if (!holds) throw ShapeError(what);
}

}  // namespace

Matrix::Matrix(Device& device, std::size_t rows, std::size_t columns)
    : device_(&device), rows_(rows), columns_(columns) {
  // Kernels index with 32-bit integers.
  if (element_count() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw DeviceError(fmt::format("a matrix of {} x {} exceeds 2^31 elements", rows, columns),
                      DeviceError::Kind::refused);
  if (empty()) return;
  buffer_ = allocate(device, element_count() * sizeof(float));
  set_zero();
}

Matrix Matrix::from_host(Device& device, const Eigen::Ref<const MatrixF>& values) {
  Matrix matrix(device, static_cast<std::size_t>(values.rows()),
                static_cast<std::size_t>(values.cols()));
  matrix.upload(values);
  return matrix;
}

Matrix Matrix::part(std::size_t first, std::size_t rows, std::size_t columns) const {
  Matrix matrix;
  matrix.device_ = device_;
  matrix.rows_ = rows;
  matrix.columns_ = columns;
  require_shape(first + matrix.element_count() <= element_count(),
                "a part reaches past its matrix");
  if (matrix.empty()) return matrix;
  const cl_buffer_region region{first * sizeof(float), matrix.element_count() * sizeof(float)};
  checked(device_->info().name, "taking a part of a matrix", [&] {
    cl::Buffer whole = buffer_;
    matrix.buffer_ =
        whole.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
  });
  return matrix;
}

Matrix Matrix::filled_with_row(const Matrix& row, std::size_t rows) {
  if (row.rows() != 1)
    throw ShapeError(fmt::format("expected a matrix of one row, not of {}", row.rows()));
  return from_host(row.device(), row.to_host().replicate(static_cast<Eigen::Index>(rows), 1));
}

MatrixF Matrix::to_host() const {
  MatrixF wide(rows_, stride());
  if (!empty()) {
    device_->finish();  // which can be interrupted
    checked(device_->info().name, "reading a matrix", [&] {
      device_->queue().enqueueReadBuffer(buffer_, CL_TRUE, 0, element_count() * sizeof(float),
                                         wide.data());
    });
  }
  return wide.leftCols(static_cast<Eigen::Index>(columns_));
}

void Matrix::upload(const Eigen::Ref<const MatrixF>& values) {
  require_shape(static_cast<std::size_t>(values.rows()) == rows_ &&
                    static_cast<std::size_t>(values.cols()) == columns_,
                "upload: the values have another shape than the matrix");
  if (empty()) return;
  MatrixF wide = MatrixF::Zero(values.rows(), static_cast<Eigen::Index>(stride()));
  wide.leftCols(values.cols()) = values;
  checked(device_->info().name, "writing a matrix", [&] {
    device_->queue().enqueueWriteBuffer(buffer_, CL_TRUE, 0, element_count() * sizeof(float),
                                        wide.data());
  });
}

void Matrix::set_zero() {
  if (empty()) return;
  checked(device_->info().name, "clearing a matrix", [&] {
    device_->queue().enqueueFillBuffer(buffer_, 0.0F, 0, element_count() * sizeof(float));
  });
}

void Matrix::copy_from(const Matrix& other) {
  require_shape(other.rows_ == rows_ && other.columns_ == columns_,
                "copy: the matrices differ in shape");
  if (empty()) return;
  checked(device_->info().name, "copying a matrix", [&] {
    device_->queue().enqueueCopyBuffer(other.buffer_, buffer_, 0, 0,
                                       element_count() * sizeof(float));
  });
}

void Matrix::copy_rows_from(const Matrix& other, std::size_t first, std::size_t count,
                            std::size_t to) {
  require_shape(other.columns_ == columns_ && first + count <= other.rows_ && to + count <= rows_,
                "copy: the rows do not fit");
  if (count == 0 || columns_ == 0) return;
  const std::size_t row_bytes = stride() * sizeof(float);
  checked(device_->info().name, "copying rows", [&] {
    device_->queue().enqueueCopyBuffer(other.buffer_, buffer_, first * row_bytes, to * row_bytes,
                                       count * row_bytes);
  });
}

IndexBuffer::IndexBuffer(Device& device, const std::vector<std::int32_t>& values)
    : size_(values.size()) {
  buffer_ = allocate(device, std::max<std::size_t>(size_, 1) * sizeof(std::int32_t));
  upload(device, values);
}

void IndexBuffer::upload(Device& device, const std::vector<std::int32_t>& values) {
  require_shape(values.size() == size_, "upload: the index has another size");
  if (values.empty()) return;
  checked(device.info().name, "writing an index", [&] {
    device.queue().enqueueWriteBuffer(buffer_, CL_TRUE, 0, size_ * sizeof(std::int32_t),
                                      values.data());
  });
}

Rows::Rows(const Matrix& all) : matrix(&all), count(all.rows()), columns(all.columns()) {}

Rows::Rows(const Matrix& from, std::size_t first_row, std::size_t row_count)
    : matrix(&from), count(row_count), columns(from.columns()), first(first_row) {
  require_shape(first_row + row_count <= from.rows(), "a block of rows reaches past the matrix");
}

Rows Rows::indexed(const Matrix& from, const IndexBuffer& index, std::size_t index_first,
                   std::size_t row_count, int shift, std::size_t frames) {
  require_shape(index_first + row_count <= index.size(), "a mini-batch reaches past the index");
  Rows rows(from);
  rows.count = row_count;
  rows.columns = frames == 1 ? from.columns() : frames * from.stride();
  rows.index = &index;
  rows.index_first = index_first;
  rows.shift = shift;
  return rows;
}

Rows Rows::strided(const Matrix& from, std::size_t first, std::size_t count, std::size_t step,
                   std::size_t frames) {
  require_shape(count == 0 || first + (count - 1) * step + frames <= from.rows(),
                "strided rows reach past the matrix");
  Rows rows(from);
  rows.count = count;
  rows.columns = frames == 1 ? from.columns() : frames * from.stride();
  rows.first = first;
  rows.step = step;
  return rows;
}

}  // namespace mcdbn
