#include "machines/track_completion.hpp"

#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr int kMeanFieldSteps = 10;

RowVectorF sigmoid(const RowVectorF& x) {
  return (1.0F + (-x.array()).exp()).inverse().matrix();
}

/// The `order` frames before `frame`, the training mean (zero) where the track has not begun.
RowVectorF history_of(const MatrixF& track, Eigen::Index frame, std::size_t order) {
  RowVectorF history = RowVectorF::Zero(static_cast<Eigen::Index>(order) * track.cols());
  for (Eigen::Index q = 0; q < static_cast<Eigen::Index>(order); ++q) {
    const Eigen::Index source = frame - static_cast<Eigen::Index>(order) + q;
    if (source >= 0) history.segment(q * track.cols(), track.cols()) = track.row(source);
  }
  return history;
}

}  // namespace

MatrixF complete_track(const Cdbn& cdbn, MatrixF track) {
  if (!track.array().isNaN().any()) return track;
  // Gaps are few and short: this runs on the host, over a copy of the lowest layer.
  const CrbmParameters layer = cdbn.layers.front().to_host();
  if (track.cols() != layer.W.rows())
    throw ShapeError("track completion: the track does not fit the CDBN");
  for (Eigen::Index t = 0; t < track.rows(); ++t) {
    const auto missing = track.row(t).array().isNaN().eval();
    if (!missing.any()) continue;
    const RowVectorF history = history_of(track, t, layer.shape.order);
    const RowVectorF visible_bias = layer.a + history * layer.A;
    const RowVectorF hidden_bias = layer.b + history * layer.B;
    RowVectorF row = missing.select(t > 0 ? RowVectorF(track.row(t - 1)) : RowVectorF(visible_bias),
                                    track.row(t));
    for (int step = 0; step < kMeanFieldSteps; ++step) {
      const RowVectorF hidden = sigmoid(hidden_bias + row * layer.W);
      const RowVectorF reconstruction = visible_bias + hidden * layer.W.transpose();
      row = missing.select(reconstruction, row);
    }
    track.row(t) = row;
  }
  return track;
}

}  // namespace mcdbn
