#pragma once

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// How far an answer of an MCDBN may be off, given the code that it was decoded from: a normal
/// distribution's standard deviation for every frame and value, σ = exp(c + h·C). The paper has
/// none: its visible units have variance 1 whatever the code.
struct AnswerDeviation {
  MatrixF C;  ///< [code x visible]
  MatrixF c;  ///< [1 x visible]

  /// @param code hidden units of the wanted modality's top layer [frames x code]
  /// @return [frames x visible], above zero  @throws ShapeError
  MatrixF of(const MatrixF& code) const;

  /// Ridge regression of the residuals' logarithms on the code: for normal residuals the mean of
  /// ln|r| is ln σ less a constant, which is then set such that r²/σ² is 1 on average in every
  /// column. The ridge is that of one more frame for each column of the code.
  /// @param code [frames x code]  @param residuals truth less answer [frames x visible]
  /// @throws ShapeError if they differ in frames or have fewer than two
  static AnswerDeviation fit(const MatrixF& code, const MatrixF& residuals);
  /// All deviations times as much as residuals of others ask for: on people that were not learnt
  /// from they are larger. @param residuals and @param deviations, of(code), of the same shape
  void calibrate(const MatrixF& residuals, const MatrixF& deviations);
};

}  // namespace mcdbn
