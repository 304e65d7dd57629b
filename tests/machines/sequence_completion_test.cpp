// Missing 2D joints filled in by the lowest layer, against double precision.

#include "machines/sequence_completion.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/units_reference.hpp"

namespace sequence_completion_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

CrbmParameters parameters(std::size_t order, VisibleKind kind) {
  CrbmParameters p = CrbmParameters::zeros({5, 5, order, kind});
  // So large that ten steps have not converged: a step less shows, and so does where they began.
  p.W = random_matrix(5, 5, 1, 1.2F);
  p.A = random_matrix(order * 5, 5, 2, 0.3F);
  p.B = random_matrix(order * 5, 5, 3, 0.5F);
  p.a = random_matrix(1, 5, 4);
  p.b = random_matrix(1, 5, 5);
  p.visible_mean = (0.5F * (random_matrix(1, 5, 6).array() + 1.0F)).matrix();
  return p;
}

/// Ten steps of mean field between the hidden units and what is missing, frame by frame. The guess
/// before the first one is the frame before, or the layer's answer without hidden units. The frames
/// before the sequence are at the training mean.
MatrixD completed(const CrbmParameters& p, const MatrixF& gappy) {
  const auto units = [&](const RowVectorD& input) {
    return p.shape.kind == VisibleKind::binary ? RowVectorD(reference::sigmoid(MatrixD(input)))
                                               : input;
  };
  MatrixD track = gappy.cast<double>();
  const auto order = static_cast<Eigen::Index>(p.shape.order);
  for (Eigen::Index t = 0; t < track.rows(); ++t) {
    RowVectorD visible_bias = p.a.cast<double>(), hidden_bias = p.b.cast<double>();
    for (Eigen::Index q = 0; q < order; ++q) {
      const RowVectorD frame = t - order + q < 0 ? RowVectorD(p.visible_mean.cast<double>())
                                                 : RowVectorD(track.row(t - order + q));
      visible_bias += frame * p.A.middleRows(5 * q, 5).cast<double>();
      hidden_bias += frame * p.B.middleRows(5 * q, 5).cast<double>();
    }
    for (Eigen::Index c = 0; c < 5; ++c)
      if (std::isnan(gappy(t, c))) track(t, c) = t > 0 ? track(t - 1, c) : units(visible_bias)(c);
    for (int step = 0; step < 10; ++step) {
      const MatrixD hidden =
          reference::sigmoid(MatrixD(hidden_bias + track.row(t) * p.W.cast<double>()));
      const RowVectorD means =
          units(RowVectorD(visible_bias + hidden * p.W.cast<double>().transpose()));
      for (Eigen::Index c = 0; c < 5; ++c)
        if (std::isnan(gappy(t, c))) track(t, c) = means(c);
    }
  }
  return track;
}

void check_completion(Device& device, const CrbmParameters& p) {
  Cdbn cdbn;
  cdbn.layers.emplace_back(device, p);
  cdbn.layers.emplace_back(
      device, CrbmParameters::random({5, 2, 1, VisibleKind::binary}, 1.0, {3, 0, 0, 0}));
  MatrixF whole = random_matrix(9, 5, 7);
  if (p.shape.kind == VisibleKind::binary) whole = (0.5F * (whole.array() + 1.0F)).matrix();
  CHECK(complete_sequence(cdbn, whole) == whole);
  MatrixF gappy = whole;
  gappy.row(0).setConstant(kNan);
  gappy(2, 1) = gappy(3, 1) = gappy(3, 4) = gappy(8, 0) = kNan;
  gappy.row(5).setConstant(kNan);
  const MatrixF filled = complete_sequence(cdbn, gappy);
  // Rounding comes to 6e-7 here. One step less or more, or another first guess, comes to 2e-4
  // at least.
  const double off = (filled.cast<double>() - completed(p, gappy)).cwiseAbs().maxCoeff();
  CHECK(!(off > 1e-5));
  CHECK(filled.allFinite());
  for (Eigen::Index t = 0; t < 9; ++t)
    for (Eigen::Index c = 0; c < 5; ++c)
      if (!std::isnan(gappy(t, c))) CHECK(filled(t, c) == whole(t, c));
  MatrixF narrow = gappy.leftCols(4);
  CHECK_THROWS_AS(complete_sequence(cdbn, narrow), ShapeError);
}

}  // namespace

TEST_CASE("track completion is the mean field of the lowest layer, frame by frame") {
  on_every_device([](Device& device) {
    for (const VisibleKind kind : {VisibleKind::gaussian, VisibleKind::binary})
      for (const std::size_t order : {0U, 1U, 3U}) {
        CAPTURE(order);
        CAPTURE(kind == VisibleKind::binary);
        check_completion(device, parameters(order, kind));
      }
  });
}

}  // namespace sequence_completion_test
