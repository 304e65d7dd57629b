#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "base/random_matrix.hpp"
#include "mcdbn/device/matrix.hpp"

namespace mcdbn::test {

/// Every OpenCL device of this machine, or those that MCDBN_PLATFORM and MCDBN_DEVICE name, opened
/// once, so that programs are built once; with MCDBN_AS_GPU set all are taken for GPUs. Never
/// closed: at the end of a process the OpenCL platform may be gone before its devices.
inline std::vector<Device>& devices() {
  static std::vector<Device>& open = *[] {
    auto all = std::make_unique<std::vector<Device>>();
    for (DeviceInfo info : matching_devices(DeviceSelection::from_environment())) {
      info.is_gpu = info.is_gpu || std::getenv("MCDBN_AS_GPU") != nullptr;
      all->emplace_back(info);
    }
    return all.release();
  }();
  return open;
}

/// Runs the test on each; fails where there is none, as nothing would be tested.
template <typename Body>
void on_every_device(Body&& body) {
  REQUIRE_MESSAGE(!devices().empty(), describe_devices({}));
  for (Device& device : devices()) {
    INFO("device: ", device.info().platform_name, ", ", device.info().name);
    body(device);
  }
}

/// The same device, taken for a GPU: its settings, work-groups and launches, on any machine.
inline Device as_gpu(const Device& device) {
  DeviceInfo info = device.info();
  info.is_gpu = true;
  return Device(info);
}

/// A whole buffer with its padding columns: [rows x stride].
inline MatrixF read_padded(const Matrix& matrix) {
  MatrixF values(matrix.rows(), matrix.stride());
  matrix.device().queue().enqueueReadBuffer(matrix.buffer(), CL_TRUE, 0,
                                            matrix.element_count() * sizeof(float), values.data());
  return values;
}

inline void write_padded(const Matrix& matrix, const MatrixF& values) {
  REQUIRE(values.size() == static_cast<Eigen::Index>(matrix.element_count()));
  matrix.device().queue().enqueueWriteBuffer(matrix.buffer(), CL_TRUE, 0,
                                             matrix.element_count() * sizeof(float), values.data());
}

/// Rows that a kernel writes, inside a bigger matrix whose other rows hold a sentinel, padding
/// columns included. The block's own columns start as NaN (they must not be read) or as `initial`.
class GuardedBlock {
 public:
  GuardedBlock(Device& device, std::size_t rows, std::size_t columns,
               const MatrixF& initial = MatrixF())
      : matrix_(device, rows + 2 * kGuardRows, columns), rows_(rows) {
    MatrixF all = MatrixF::Constant(matrix_.rows(), matrix_.stride(), kSentinel);
    auto block = all.middleRows(kGuardRows, rows);
    block.setZero();
    if (initial.size() > 0)
      block.leftCols(columns) = initial;
    else
      block.leftCols(columns).setConstant(std::numeric_limits<float>::quiet_NaN());
    write_padded(matrix_, all);
  }

  GuardedBlock(const GuardedBlock&) = delete;  // rows() refers to this one
  GuardedBlock& operator=(const GuardedBlock&) = delete;

  Rows rows() const { return {matrix_, kGuardRows, rows_}; }
  MatrixF values() const { return matrix_.to_host().middleRows(kGuardRows, rows_); }
  const Matrix& matrix() const { return matrix_; }

  /// Nothing around the block was written, and its padding columns are exactly zero.
  bool intact() const {
    const MatrixF all = read_padded(matrix_);
    const auto padding = all.middleRows(kGuardRows, rows_)
                             .rightCols(all.cols() - static_cast<Eigen::Index>(matrix_.columns()));
    return (all.topRows(kGuardRows).array() == kSentinel).all() &&
           (all.bottomRows(kGuardRows).array() == kSentinel).all() &&
           (padding.array() == 0.0F).all();
  }

  static constexpr std::size_t kGuardRows = 2;

 private:
  static constexpr float kSentinel = -12345.678F;
  Matrix matrix_;
  std::size_t rows_;
};

/// The padding columns of a whole matrix are exactly zero.
inline bool padding_is_zero(const Matrix& matrix) {
  const MatrixF all = read_padded(matrix);
  return (all.rightCols(all.cols() - static_cast<Eigen::Index>(matrix.columns())).array() == 0.0F)
      .all();
}

}  // namespace mcdbn::test
