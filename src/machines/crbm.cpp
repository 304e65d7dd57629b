#include "mcdbn/machines/crbm.hpp"

#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

enum WeightPhase : std::uint16_t { kWeightsW = 1, kWeightsA, kWeightsB };

MatrixF normal_matrix(Eigen::Index rows, Eigen::Index columns, double deviation, RandomKey key,
                      WeightPhase phase) {
  key.phase = phase;
  MatrixF values(rows, columns);
  for (Eigen::Index r = 0; r < rows; ++r)
    for (Eigen::Index c = 0; c < columns; ++c)
      values(r, c) =
          static_cast<float>(deviation * random_normal(key, static_cast<std::uint32_t>(r),
                                                       static_cast<std::uint32_t>(c)));
  return values;
}

/// [order·visible x n] → [order·padded(visible) x n], each frame's rows followed by rows of zeros.
MatrixF with_frame_padding(const MatrixF& weights, const CrbmShape& shape) {
  const auto order = static_cast<Eigen::Index>(shape.order);
  const auto visible = static_cast<Eigen::Index>(shape.visible);
  const auto stride = static_cast<Eigen::Index>(padded(shape.visible));
  MatrixF wide = MatrixF::Zero(order * stride, weights.cols());
  for (Eigen::Index q = 0; q < order; ++q)
    wide.middleRows(q * stride, visible) = weights.middleRows(q * visible, visible);
  return wide;
}

MatrixF without_frame_padding(const MatrixF& wide, const CrbmShape& shape) {
  const auto order = static_cast<Eigen::Index>(shape.order);
  const auto visible = static_cast<Eigen::Index>(shape.visible);
  const auto stride = static_cast<Eigen::Index>(padded(shape.visible));
  MatrixF weights(order * visible, wide.cols());
  for (Eigen::Index q = 0; q < order; ++q)
    weights.middleRows(q * visible, visible) = wide.middleRows(q * stride, visible);
  return weights;
}

}  // namespace

CrbmParameters CrbmParameters::zeros(const CrbmShape& shape) {
  const auto visible = static_cast<Eigen::Index>(shape.visible);
  const auto hidden = static_cast<Eigen::Index>(shape.hidden);
  const auto history = static_cast<Eigen::Index>(shape.order) * visible;
  return {shape,
          MatrixF::Zero(visible, hidden),
          MatrixF::Zero(history, visible),
          MatrixF::Zero(history, hidden),
          MatrixF::Zero(1, visible),
          MatrixF::Zero(1, hidden),
          MatrixF::Zero(1, visible)};
}

CrbmParameters CrbmParameters::random(const CrbmShape& shape, double deviation,
                                      const RandomKey& key) {
  CrbmParameters parameters = zeros(shape);
  const auto draw = [&](MatrixF& matrix, WeightPhase phase) {
    matrix = normal_matrix(matrix.rows(), matrix.cols(), deviation, key, phase);
  };
  draw(parameters.W, kWeightsW);
  draw(parameters.A, kWeightsA);
  draw(parameters.B, kWeightsB);
  return parameters;
}

Crbm::Crbm(Device& device, const CrbmParameters& parameters)
    : W(Matrix::from_host(device, parameters.W)),
      A(Matrix::from_host(device, with_frame_padding(parameters.A, parameters.shape))),
      B(Matrix::from_host(device, with_frame_padding(parameters.B, parameters.shape))),
      a(Matrix::from_host(device, parameters.a)),
      b(Matrix::from_host(device, parameters.b)),
      W_transposed(device, parameters.shape.hidden, parameters.shape.visible),
      visible_mean(Matrix::from_host(device, parameters.visible_mean)),
      shape_(parameters.shape) {
  if (W.rows() != shape_.visible || W.columns() != shape_.hidden || a.columns() != shape_.visible ||
      b.columns() != shape_.hidden)
    throw ShapeError("CRBM: the parameters do not fit the shape");
  refresh_transposed();
}

CrbmParameters Crbm::to_host() const {
  return {shape_,
          W.to_host(),
          without_frame_padding(A.to_host(), shape_),
          without_frame_padding(B.to_host(), shape_),
          a.to_host(),
          b.to_host(),
          visible_mean.to_host()};
}

Rows Crbm::history(const Rows& rows) const {
  const int order = static_cast<int>(shape_.order);
  if (!rows.index && rows.first < shape_.order)
    throw ShapeError("CRBM: a row has fewer frames before it than the order");
  Rows past = rows.index ? Rows::indexed(*rows.matrix, *rows.index, rows.index_first, rows.count,
                                         rows.shift - order, shape_.order)
                         : Rows::strided(*rows.matrix, rows.first - shape_.order, rows.count,
                                         rows.step, shape_.order);
  // A and B have rows for the padding of every frame, so a history of one has its padding too.
  past.columns = shape_.order * rows.matrix->stride();
  return past;
}

void Crbm::dynamic_hidden_bias(const Rows& rows, const Rows& out) const {
  GemmOptions options;
  options.bias = &b;
  gemm(history(rows), B, out, options);
}

void Crbm::dynamic_visible_bias(const Rows& rows, const Rows& out) const {
  GemmOptions options;
  options.bias = &a;
  gemm(history(rows), A, out, options);
}

void Crbm::hidden_probabilities(const Rows& rows, const Rows& out) const {
  GemmOptions options;
  options.activation = Activation::sigmoid;
  if (shape_.order > 0) {
    dynamic_hidden_bias(rows, out);
    options.beta = 1.0F;
  } else {
    options.bias = &b;
  }
  gemm(rows, W, out, options);
}

void Crbm::refresh_transposed() {
  transpose(W, W_transposed);
}

}  // namespace mcdbn
