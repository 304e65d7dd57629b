#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

/// One trained matrix of a machine.
struct ParameterShape {
  std::string name;  ///< the paper's letter
  std::size_t rows = 0, columns = 0;
  bool is_weight = true;  ///< biases do not decay
  /// The rows are frames of so many units, oldest first, each padded as a row of a matrix is, so
  /// that a history is multiplied with its padding; 0: rows as they are.
  std::size_t frame_rows = 0;

  /// Rows on the device.
  std::size_t device_rows() const {
    return frame_rows == 0 ? rows : rows / frame_rows * padded(frame_rows);
  }
  std::size_t floats() const { return device_rows() * padded(columns); }
  bool operator==(const ParameterShape&) const = default;
};

/// All trained matrices of a machine, by name, one after another in one buffer: an optimizer, a
/// checkpoint, a model file are each one loop over the entries. Copies share the buffer.
class Parameters {
 public:
  struct Entry : ParameterShape {
    std::size_t first = 0;  ///< its first float in the buffer
  };

  /// All zeros. @throws ShapeError for a name that comes twice
  Parameters(Device& device, const std::vector<ParameterShape>& shapes);

  /// The entries whose names begin with `prefix`, without it, in the same buffer.
  Parameters part(std::string_view prefix) const;

  const std::vector<Entry>& entries() const { return entries_; }
  /// @throws ShapeError if there is none of that name
  const Entry& entry(std::string_view name) const;
  /// [device_rows x columns], in place: what is done to it is done to the parameter.
  Matrix matrix(std::string_view name) const;
  /// These entries in another buffer of this layout [1 x floats], of gradients or averages.
  /// @throws ShapeError
  Parameters in(const Matrix& buffer) const;

  /// All of them become those in `buffer`, which has this layout. @throws ShapeError
  void copy_from(const Matrix& buffer) { values_.copy_from(buffer); }

  /// The whole buffer [1 x floats].
  const Matrix& all() const { return values_; }
  Device& device() const { return values_.device(); }

  /// Without padding. @return [rows x columns]
  MatrixF to_host(std::string_view name) const;
  /// @param values [rows x columns]  @throws ShapeError
  void upload(std::string_view name, const MatrixF& values);

 private:
  Parameters(Matrix values, std::vector<Entry> entries)
      : values_(std::move(values)), entries_(std::move(entries)) {}

  Matrix values_;
  std::vector<Entry> entries_;
};

}  // namespace mcdbn
