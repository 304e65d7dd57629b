#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// z-scores columns; columns that never change are dropped and come back exactly.
class Standardizer {
 public:
  /// Mean and population deviation of every column over all rows of all blocks, NaN left out.
  /// A column that deviates by less than `kSmallestDeviation`, or has no number at all, is dropped.
  /// @param blocks each [rows x input]  @throws ShapeError
  static Standardizer fit(const std::vector<const MatrixD*>& blocks);
  static constexpr double kSmallestDeviation = 1e-6;

  int input_dimension() const { return static_cast<int>(mean_.size()); }
  int output_dimension() const { return static_cast<int>(kept_.size()); }
  const std::vector<int>& kept_columns() const { return kept_; }
  /// [rows x input] → [rows x output]; NaN stays NaN. @throws ShapeError
  MatrixF apply(const MatrixD& values) const;
  /// [rows x output] → [rows x input] @throws ShapeError
  MatrixD invert(const MatrixF& standardized) const;
  const RowVectorD& mean() const { return mean_; }
  const RowVectorD& deviation() const { return deviation_; }

  nlohmann::json to_json() const;
  /// @param where it stands, for errors: "model.safetensors: modalities.pose_scale"
  /// @throws InputError
  static Standardizer from_json(const nlohmann::json& json, const std::string& where);

 private:
  RowVectorD mean_, deviation_;  ///< [1 x input]
  std::vector<int> kept_;        ///< columns that vary
};

}  // namespace mcdbn
