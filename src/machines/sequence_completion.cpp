#include "machines/sequence_completion.hpp"

#include "machines/crbm_on_host.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr int kMeanFieldSteps = 10;

/// The `order` frames before `frame`, the training mean where the sequence has not begun.
/// @param mean, sequence as the layer's own units see them
MatrixF history_of(const MatrixF& sequence, Eigen::Index frame, std::size_t order,
                   const MatrixF& mean) {
  MatrixF history = mean.replicate(1, static_cast<Eigen::Index>(order));
  for (Eigen::Index q = 0; q < static_cast<Eigen::Index>(order); ++q) {
    const Eigen::Index source = frame - static_cast<Eigen::Index>(order) + q;
    if (source >= 0)
      history.middleCols(q * sequence.cols(), sequence.cols()) = sequence.row(source);
  }
  return history;
}

/// @param sequence as the layer's own units see it
MatrixF completed(const CrbmParameters& layer, MatrixF sequence) {
  const MatrixF mean = (layer.visible_mean.array() / layer.visible_deviation.array()).matrix();
  for (Eigen::Index t = 0; t < sequence.rows(); ++t) {
    const auto missing = sequence.row(t).array().isNaN().eval();
    if (!missing.any()) continue;
    const MatrixF history = history_of(sequence, t, layer.shape.order, mean);
    const MatrixF nothing = MatrixF::Zero(1, layer.W.cols());
    MatrixF row = t > 0 ? MatrixF(sequence.row(t - 1)) : visible_on_host(layer, nothing, history);
    row = missing.select(row, sequence.row(t));
    for (int step = 0; step < kMeanFieldSteps; ++step) {
      const MatrixF hidden = hidden_on_host(layer, row, history);
      row = missing.select(visible_on_host(layer, hidden, history), row);
    }
    sequence.row(t) = row;
  }
  return sequence;
}

}  // namespace

MatrixF complete_sequence(const Cdbn& cdbn, MatrixF sequence) {
  const auto missing = sequence.array().isNaN().eval();
  if (!missing.any()) return sequence;
  // Gaps are few and short: this runs on the host, over a copy of the lowest layer.
  const CrbmParameters layer = cdbn.layers.front().to_host();
  if (sequence.cols() != layer.W.rows())
    throw ShapeError("gaps: the sequence does not fit the CDBN");
  const auto deviation = layer.visible_deviation.row(0).array();
  const MatrixF filled =
      completed(layer, (sequence.array().rowwise() / deviation).matrix()).array().rowwise() *
      deviation;
  return missing.select(filled, sequence);
}

}  // namespace mcdbn
