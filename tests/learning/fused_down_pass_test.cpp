#include "learning/fused_down_pass.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/fitting_tiles.hpp"
#include "device/pointwise.hpp"
#include "learning/small_network.hpp"
#include "reference/error_bounds.hpp"

namespace fused_down_pass_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::kRoundoff;
using reference::misfit;

namespace {

struct Case {
  CrbmShape shape;
  InputKind input_kind;
  SequenceWindows windows;
  float kept_share = 1.0F;
};

/// Every kind of unit; sizes that fill no vector and no tile, a history longer than what follows
/// it.
const std::vector<Case> kCases = {
    {{5, 3, 2, VisibleKind::gaussian}, InputKind::data, {3, 7, 2, 3}},
    {{17, 4, 3, VisibleKind::gaussian}, InputKind::data, {7, 6, 4, 5}},
    {{33, 2, 1, VisibleKind::binary}, InputKind::data, {5, 5, 2, 2}},
    {{19, 3, 4, VisibleKind::binary}, InputKind::code, {5, 7, 5, 6}},
    {{3, 3, 2, VisibleKind::binary, 1, 2}, InputKind::code, {2, 9, 3, 4}, 0.75F}};

/// Numbers as in training, all of the same every time.
struct Problem {
  explicit Problem(const Case& test)
      : rows(test.windows.rows()),
        input_from_above(
            random_matrix(test.windows.count * (test.windows.frames - test.windows.first),
                          test.shape.visible, 1)),
        states(random_matrix(rows, test.shape.visible, 2, 0.4F)),
        errors(random_matrix(rows, test.shape.visible, 3)),
        A(random_layer(test.shape, 4).A) {}
  std::size_t rows;
  MatrixF input_from_above, states, errors, A;
};

struct Passed {
  MatrixF states, errors;
  bool operator==(const Passed&) const = default;
};

/// The layer's part of a network in training.
struct OnDevice {
  OnDevice(Device& device, const Case& test, const Problem& problem)
      : parameters(device, Crbm::parameter_shapes(test.shape)),
        layer(parameters, parameters, CrbmParameters::zeros(test.shape), test.input_kind) {
    CrbmParameters all = random_layer(test.shape, 4);
    all.A = problem.A;
    all.write(parameters);
    transpose_lags(layer.crbm.A, test.shape.order_A(), layer.A_following);
  }
  Parameters parameters;
  UnrolledNetwork::Layer layer;
};

/// There and back, from states that are given for the way back.
Passed passed(Device& device, const Case& test, std::optional<RowTile> tile) {
  const Problem problem(test);
  const OnDevice own(device, test, problem);
  const auto pass = tile ? FusedDownPass(own.layer, test.input_kind, test.windows, *tile)
                         : FusedDownPass::of(own.layer, test.input_kind, test.windows).value();
  const Matrix states = Matrix::from_host(device, problem.states);
  const Matrix errors = Matrix::from_host(device, problem.errors);
  pass.backward(states, errors, test.kept_share);
  const Matrix input_from_above = Matrix::from_host(device, problem.input_from_above);
  pass.forward(input_from_above, states);
  return {states.to_host(), errors.to_host()};
}

/// A frame's sum over so many others: what it should be, and the bound (k + 2)·u of such a sum.
struct Sum {
  RowVectorD value, size;
  double terms = 2;
  void add(const RowVectorD& frame, const MatrixD& weights) {
    value += frame * weights;
    size += frame.cwiseAbs() * weights.cwiseAbs();
    terms += static_cast<double>(frame.size());
  }
  RowVectorD bound() const { return terms * kRoundoff * size; }
};

/// Every frame from the device's own frames before it.
void check_forward(const Case& test, const MatrixD& got) {
  const Problem problem(test);
  const std::size_t order = test.shape.order_A(), v = test.shape.visible;
  const SequenceWindows& windows = test.windows;
  for (std::size_t row = 0; row < windows.rows(); ++row) {
    CAPTURE(row);
    const std::size_t window = row / windows.frames, frame = row % windows.frames;
    const auto at = static_cast<Eigen::Index>(row);
    if (frame < windows.first) {
      CHECK(got.row(at) == problem.states.row(at).cast<double>());
      continue;
    }
    const RowVectorD input_from_above =
        problem.input_from_above
            .row(static_cast<Eigen::Index>(window * (windows.frames - windows.first) + frame -
                                           windows.first))
            .cast<double>();
    Sum sum{input_from_above, input_from_above.cwiseAbs()};
    for (std::size_t q = 0; q < order; ++q)
      sum.add(got.row(at - static_cast<Eigen::Index>(order - q)),
              problem.A.middleRows(static_cast<Eigen::Index>(q * v), static_cast<Eigen::Index>(v))
                  .cast<double>());
    RowVectorD want = sum.value, bound = sum.bound();
    if (test.shape.kind == VisibleKind::binary) {
      const RowVectorD p = (1.0 + (-want.array()).exp()).inverse().matrix();
      bound = 0.25 * bound + reference::kSigmoidError * kRoundoff * p;
      want = p;
      if (test.input_kind == InputKind::code) {
        want.array() -= 0.5;
        bound.array() += kRoundoff;
      }
    }
    CHECK(misfit(got.row(at), want, bound) == "");
  }
}

/// Every frame from the device's own errors of the frames that follow.
void check_backward(const Case& test, const MatrixD& got) {
  const Problem problem(test);
  const std::size_t order = test.shape.order_A(), v = test.shape.visible;
  const SequenceWindows& windows = test.windows;
  for (std::size_t row = 0; row < windows.rows(); ++row) {
    CAPTURE(row);
    const std::size_t frame = row % windows.frames;
    const auto at = static_cast<Eigen::Index>(row);
    const RowVectorD own = problem.errors.row(at).cast<double>();
    if (frame < windows.first) {
      CHECK(got.row(at) == own);
      continue;
    }
    Sum sum{own, own.cwiseAbs()};
    for (std::size_t later = 1; later <= order && frame + later < windows.frames; ++later)
      sum.add(got.row(at + static_cast<Eigen::Index>(later)),
              problem.A
                  .middleRows(static_cast<Eigen::Index>((order - later) * v),
                              static_cast<Eigen::Index>(v))
                  .transpose()
                  .cast<double>());
    RowVectorD slope = RowVectorD::Ones(static_cast<Eigen::Index>(v));
    const RowVectorD y = problem.states.row(at).cast<double>();
    const double kept = test.kept_share;
    if (test.input_kind == InputKind::code)
      slope = ((0.25 - (kept * y.array()).square()) / kept).matrix();
    else if (test.shape.kind == VisibleKind::binary)
      slope = (y.array() * (1.0 - y.array())).matrix();
    // The slope's own few operations, relative to its parts.
    const RowVectorD slope_bound =
        ((0.25 + y.array().square() + y.array().abs()) / kept * (8.0 + reference::kDivisionError))
            .matrix() *
        kRoundoff;
    const RowVectorD want = sum.value.cwiseProduct(slope);
    const RowVectorD bound = sum.bound().cwiseProduct(slope.cwiseAbs() + slope_bound) +
                             (sum.value.cwiseAbs() + sum.bound())
                                 .cwiseProduct(slope_bound + kRoundoff * slope.cwiseAbs());
    CHECK(misfit(got.row(at), want, bound) == "");
  }
}

}  // namespace

TEST_CASE(
    "small: the fused down-pass and its way back are the double reference's, frame by frame") {
  on_every_device([](Device& device) {
    for (const Case& test : kCases) {
      CAPTURE(test.shape.visible);
      const Passed got = passed(device, test, std::nullopt);
      check_forward(test, got.states.cast<double>());
      check_backward(test, got.errors.cast<double>());
    }
  });
}

TEST_CASE("small: every tile of the fused down-pass gives the same bits") {
  on_every_device([](Device& device) {
    for (const Case& test : {kCases[1], kCases[3]}) {
      const Passed want = passed(device, test, std::nullopt);
      for (const RowTile& tile :
           fitting_tiles(device, {{16, 3, 2, 1}, {8, 5, 1, 1}, {4, 2, 1, 4}, {1, 4, 3, 8}})) {
        CAPTURE(tile.vector_width);
        CAPTURE(tile.group);
        CHECK(passed(device, test, tile) == want);
      }
    }
  });
}

}  // namespace fused_down_pass_test
