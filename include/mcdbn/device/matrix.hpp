#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Columns of a device matrix are padded to this many floats, one vector of the widest kernels.
inline constexpr std::size_t kColumnPad = 16;
constexpr std::size_t padded(std::size_t columns) {
  return (columns + kColumnPad - 1) / kColumnPad * kColumnPad;
}

/// A row-major float matrix on the device. Padding columns are zero and every kernel keeps them so.
class Matrix {
 public:
  Matrix() = default;
  /// All zeros. @throws DeviceError
  Matrix(Device& device, std::size_t rows, std::size_t columns);
  static Matrix from_host(Device& device, const Eigen::Ref<const MatrixF>& values);
  /// All zeros, of `other`'s shape, on its device.
  static Matrix like(const Matrix& other) {
    return {other.device(), other.rows(), other.columns()};
  }

  /// Some of the floats of this matrix as one of its own, in place: rows of padded(columns) floats
  /// from float `first` on. `first` must be a multiple of what the device can address
  /// (parameters.hpp). @throws ShapeError if they do not lie within it
  Matrix part(std::size_t first, std::size_t rows, std::size_t columns) const;

  /// `row` [1 x n] repeated. @return [rows x n]  @throws ShapeError for more than one row
  static Matrix filled_with_row(const Matrix& row, std::size_t rows);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t stride() const { return padded(columns_); }  ///< floats from row to row
  std::size_t element_count() const { return rows_ * stride(); }
  const cl::Buffer& buffer() const { return buffer_; }
  Device& device() const { return *device_; }
  bool empty() const { return rows_ == 0 || columns_ == 0; }

  /// Waits for the queue, then reads. @return [rows x columns]
  MatrixF to_host() const;
  /// @param values [rows x columns]  @throws ShapeError
  void upload(const Eigen::Ref<const MatrixF>& values);
  void set_zero();
  /// Enqueues a copy of `other`, which has the same shape. @throws ShapeError
  void copy_from(const Matrix& other);
  /// Enqueues a copy of `count` rows of `other`, which has as many columns. @throws ShapeError
  void copy_rows_from(const Matrix& other, std::size_t first, std::size_t count, std::size_t to);

 private:
  Device* device_ = nullptr;
  std::size_t rows_ = 0, columns_ = 0;
  cl::Buffer buffer_;
};

/// Frame numbers on the device: which rows of a frame matrix make up each mini-batch.
class IndexBuffer {
 public:
  IndexBuffer() = default;
  IndexBuffer(Device& device, const std::vector<std::int32_t>& values);
  std::size_t size() const { return size_; }
  const cl::Buffer& buffer() const { return buffer_; }
  /// @throws ShapeError if the size differs
  void upload(Device& device, const std::vector<std::int32_t>& values);

 private:
  std::size_t size_ = 0;
  cl::Buffer buffer_;
};

/// Some rows of a matrix, as an operand: a block of consecutive rows, or the rows that an index
/// names. Holds references only.
struct Rows {
  const Matrix* matrix = nullptr;
  std::size_t count = 0;
  std::size_t columns = 0;  ///< may exceed the matrix's: a window of following frames
  std::size_t first = 0;    ///< first row of a block (without index)
  std::size_t step = 1;     ///< rows from one to the next (without index)
  const IndexBuffer* index = nullptr;
  std::size_t index_first = 0;  ///< first entry of the index to use
  int shift = 0;                ///< added to every index entry

  Rows(const Matrix& all);  // NOLINT: a matrix is all of its rows
  Rows(const Matrix& from, std::size_t first_row, std::size_t row_count);
  /// Row r is row index[index_first + r] + shift; `frames` rows in a row (with their padding) make
  /// one long row, which is how histories are read in place (eq 15).
  static Rows indexed(const Matrix& from, const IndexBuffer& index, std::size_t index_first,
                      std::size_t row_count, int shift = 0, std::size_t frames = 1);

  /// Rows first, first + step, first + 2·step …, each running on over `frames` rows: one frame of
  /// many sequences that lie one after another.
  static Rows strided(const Matrix& from, std::size_t first, std::size_t count, std::size_t step,
                      std::size_t frames = 1);

  int offset() const { return static_cast<int>(first * matrix->stride()); }
  int stride() const { return static_cast<int>(step * matrix->stride()); }
};

}  // namespace mcdbn
