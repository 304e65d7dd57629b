#include "mcdbn/machines/crbm.hpp"

#include "base/interruption.hpp"
#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

enum WeightPhase : std::uint16_t { kWeightsW = 1, kWeightsA, kWeightsB };

MatrixF normal_matrix(Eigen::Index rows, Eigen::Index columns, double deviation, RandomKey key,
                      WeightPhase phase) {
  key.phase = static_cast<std::uint16_t>(key.phase + phase);
  MatrixF values(rows, columns);
  for (Eigen::Index r = 0; r < rows; ++r) {
    check_interruption();
    for (Eigen::Index c = 0; c < columns; ++c)
      values(r, c) =
          static_cast<float>(deviation * random_normal(key, static_cast<std::uint32_t>(r),
                                                       static_cast<std::uint32_t>(c)));
  }
  return values;
}

Parameters uploaded(Device& device, const CrbmParameters& start) {
  Parameters parameters(device, Crbm::parameter_shapes(start.shape));
  start.write(parameters);
  return parameters;
}

/// The frames before each row, as one long row.
Rows frames_before(const Rows& rows, std::size_t order) {
  if (!rows.index && rows.first < order)
    throw ShapeError("CRBM: a row has fewer frames before it than the order");
  Rows past = rows.index
                  ? Rows::indexed(*rows.matrix, *rows.index, rows.index_first, rows.count,
                                  rows.shift - static_cast<int>(order), order)
                  : Rows::strided(*rows.matrix, rows.first - order, rows.count, rows.step, order);
  // A and B have rows for the padding of every frame, so a history of one has its padding too.
  past.columns = order * rows.matrix->stride();
  return past;
}

}  // namespace

bool CrbmShape::operator==(const CrbmShape& other) const {
  return visible == other.visible && hidden == other.hidden && order == other.order &&
         kind == other.kind && order_A() == other.order_A() && order_B() == other.order_B();
}

CrbmParameters CrbmParameters::zeros(const CrbmShape& shape) {
  const auto visible = static_cast<Eigen::Index>(shape.visible);
  const auto hidden = static_cast<Eigen::Index>(shape.hidden);
  return {shape,
          MatrixF::Zero(visible, hidden),
          MatrixF::Zero(static_cast<Eigen::Index>(shape.order_A()) * visible, visible),
          MatrixF::Zero(static_cast<Eigen::Index>(shape.order_B()) * visible, hidden),
          MatrixF::Zero(1, visible),
          MatrixF::Zero(1, hidden),
          MatrixF::Zero(1, visible),
          MatrixF::Ones(1, visible)};
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

CrbmParameters CrbmParameters::read(const Parameters& from, const CrbmShape& shape) {
  return {shape,
          from.to_host("W"),
          from.to_host("A"),
          from.to_host("B"),
          from.to_host("a"),
          from.to_host("b"),
          MatrixF::Zero(1, static_cast<Eigen::Index>(shape.visible)),
          MatrixF::Ones(1, static_cast<Eigen::Index>(shape.visible))};
}

void CrbmParameters::write(Parameters to) const {
  to.upload("W", W);
  to.upload("A", A);
  to.upload("B", B);
  to.upload("a", a);
  to.upload("b", b);
}

std::vector<ParameterShape> Crbm::parameter_shapes(const CrbmShape& shape) {
  const std::size_t visible = shape.visible, seen_by_A = shape.order_A() * visible,
                    seen_by_B = shape.order_B() * visible;
  if (shape.order_A() > shape.order || shape.order_B() > shape.order)
    throw ShapeError("CRBM: A or B sees more frames than the order");
  return {{.name = "W", .rows = visible, .columns = shape.hidden},
          {.name = "A", .rows = seen_by_A, .columns = visible, .frame_rows = visible},
          {.name = "B", .rows = seen_by_B, .columns = shape.hidden, .frame_rows = visible},
          {.name = "a", .rows = 1, .columns = visible, .is_weight = false},
          {.name = "b", .rows = 1, .columns = shape.hidden, .is_weight = false}};
}

CrbmMatrices::CrbmMatrices(const Parameters& parameters)
    : W(parameters.matrix("W")),
      A(parameters.matrix("A")),
      B(parameters.matrix("B")),
      a(parameters.matrix("a")),
      b(parameters.matrix("b")) {}

Crbm::Crbm(Device& device, const CrbmParameters& start)
    : Crbm(uploaded(device, start), start.shape, start.visible_mean, start.visible_deviation) {}

Crbm::Crbm(const Parameters& parameters, const CrbmShape& shape, const MatrixF& visible_mean_row,
           const MatrixF& visible_deviation_row)
    : CrbmMatrices(parameters),
      W_transposed(parameters.device(), shape.hidden, shape.visible),
      visible_mean(Matrix::from_host(parameters.device(), visible_mean_row)),
      visible_deviation(Matrix::from_host(
          parameters.device(), visible_deviation_row.size() > 0
                                   ? visible_deviation_row
                                   : MatrixF::Ones(1, static_cast<Eigen::Index>(shape.visible)))),
      has_deviation(visible_deviation_row.size() > 0 &&
                    (visible_deviation_row.array() != 1.0F).any()),
      shape_(shape),
      parameters_(parameters) {
  refresh_transposed();
}

CrbmParameters Crbm::to_host() const {
  CrbmParameters host = CrbmParameters::read(parameters_, shape_);
  host.visible_mean = visible_mean.to_host();
  host.visible_deviation = visible_deviation.to_host();
  return host;
}

Rows Crbm::history(const Rows& rows) const {
  return frames_before(rows, shape_.order);
}
Rows Crbm::history_for_A(const Rows& rows) const {
  return frames_before(rows, shape_.order_A());
}
Rows Crbm::history_for_B(const Rows& rows) const {
  return frames_before(rows, shape_.order_B());
}

void Crbm::dynamic_hidden_bias(const Rows& rows, const Rows& out) const {
  GemmOptions options;
  options.bias = &b;
  gemm(history_for_B(rows), B, out, options);
}

void Crbm::dynamic_visible_bias(const Rows& rows, const Rows& out) const {
  GemmOptions options;
  options.bias = &a;
  gemm(history_for_A(rows), A, out, options);
}

void Crbm::hidden_probabilities(const Rows& rows, const Rows& out) const {
  GemmOptions options;
  options.activation = Activation::sigmoid;
  if (shape_.order_B() > 0) {
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
