#include "machines/crbm_on_host.hpp"

namespace mcdbn {

MatrixF sigmoid_on_host(const MatrixF& x) {
  return (1.0F + (-x.array()).exp()).inverse().matrix();
}

MatrixF hidden_on_host(const CrbmParameters& crbm, const MatrixF& visible, const MatrixF& history) {
  MatrixF input = visible * crbm.W + history.rightCols(crbm.B.rows()) * crbm.B;
  input.rowwise() += crbm.b.row(0);
  return sigmoid_on_host(input);
}

MatrixF visible_on_host(const CrbmParameters& crbm, const MatrixF& hidden, const MatrixF& history) {
  MatrixF mean = hidden * crbm.W.transpose() + history.rightCols(crbm.A.rows()) * crbm.A;
  mean.rowwise() += crbm.a.row(0);
  return crbm.shape.kind == VisibleKind::binary ? sigmoid_on_host(mean) : mean;
}

}  // namespace mcdbn
