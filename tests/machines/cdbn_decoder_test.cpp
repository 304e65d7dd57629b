#include "machines/cdbn_decoder.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/random_crbm.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/units_reference.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using reference::gamma_n;
using reference::kRoundoff;
using reference::kSigmoidError;
using reference::misfit;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;
constexpr std::size_t kFrames = 13;
constexpr std::uint16_t kStream = 200;

CrbmParameters parameters_of(const CrbmShape& shape, unsigned seed) {
  return random_crbm(shape, seed, 4.0F);
}

MatrixF random_code(std::size_t rows, std::size_t columns) {
  return (0.5F * (random_matrix(rows, columns, 99).array() + 1.0F)).matrix();
}

struct Sums {
  MatrixD value, magnitude;  ///< magnitude: of the terms, for the bound
};

/// bias + Σ over the history of frame t, both sequences' rows and their magnitudes.
Sums with_history(const MatrixF& states, std::size_t sequences, std::size_t frame,
                  const MatrixF& weights, const MatrixF& bias, std::size_t order) {
  const auto visible = states.cols();
  Sums sums{MatrixD(sequences, bias.cols()), MatrixD(sequences, bias.cols())};
  const MatrixD W = weights.cast<double>(), b = bias.cast<double>();
  for (std::size_t i = 0; i < sequences; ++i) {
    RowVectorD history(static_cast<Eigen::Index>(order) * visible);
    for (std::size_t q = 0; q < order; ++q)
      history.segment(static_cast<Eigen::Index>(q) * visible, visible) =
          states.row(static_cast<Eigen::Index>(i * kFrames + frame - order + q)).cast<double>();
    sums.value.row(static_cast<Eigen::Index>(i)) = b + history * W;
    sums.magnitude.row(static_cast<Eigen::Index>(i)) =
        b.cwiseAbs() + history.cwiseAbs() * W.cwiseAbs();
  }
  return sums;
}

/// Row i is row i · kFrames + frame.
MatrixD at_frame(const MatrixF& all, std::size_t sequences, std::size_t frame) {
  MatrixD rows(sequences, all.cols());
  for (std::size_t i = 0; i < sequences; ++i)
    rows.row(static_cast<Eigen::Index>(i)) =
        all.row(static_cast<Eigen::Index>(i * kFrames + frame)).cast<double>();
  return rows;
}

MatrixF decoded(Device& device, const std::vector<CrbmParameters>& layers, const MatrixF& code,
                std::size_t sequences, const RegenerationOptions& options, bool fused = true) {
  Cdbn cdbn;
  for (const CrbmParameters& layer : layers) cdbn.layers.emplace_back(device, layer);
  const Matrix on_device = Matrix::from_host(device, code);
  CdbnDecoder decoder(cdbn, on_device, sequences);
  decoder.decode(layers.back().shape.order, kFrames, options, fused);
  return decoder.visible().to_host();
}

/// Every frame of a layer from the device's own frames before it and what the layer above gave, so
/// that errors do not build up and one frame's bound is enough (Higham 3.5).
void check_means(const MatrixF& states, const MatrixF& above, const CrbmParameters& p,
                 std::size_t sequences, std::size_t first) {
  const double terms = static_cast<double>(p.A.rows() + p.W.cols()) + 4.0;
  for (std::size_t frame = first; frame < kFrames; ++frame) {
    CAPTURE(frame);
    const MatrixD code = at_frame(above, sequences, frame), W = p.W.cast<double>();
    Sums sums = with_history(states, sequences, frame, p.A, p.a, p.shape.order);
    sums.value += code * W.transpose();
    sums.magnitude += code.cwiseAbs() * W.cwiseAbs().transpose();
    MatrixD want = sums.value, bound = gamma_n(terms) * sums.magnitude;
    if (p.shape.kind == kBinary) {
      want = reference::sigmoid(want);
      bound = (0.25 * bound).array() + kSigmoidError * kRoundoff;
    }
    CHECK(misfit(at_frame(states, sequences, frame), want, bound) == "");
  }
}

MatrixD uniforms(const RandomKey& key, Eigen::Index rows, Eigen::Index columns) {
  MatrixD u(rows, columns);
  for (Eigen::Index r = 0; r < rows; ++r)
    for (Eigen::Index c = 0; c < columns; ++c)
      u(r, c) = random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return u;
}

/// Algorithm 5's Gibbs steps at temperature 1, frame by frame as above. A sequence's frame counts
/// only if every draw is further from its probability than rounding reaches.
/// @return how many counted
std::size_t check_samples(const MatrixF& states, const MatrixF& code, const CrbmParameters& p,
                          std::size_t sequences, const RegenerationOptions& options) {
  const MatrixD W = p.W.cast<double>();
  const auto terms = static_cast<double>(p.A.rows() + p.W.size()) + 4.0;
  std::size_t counted = 0;
  for (std::size_t frame = p.shape.order; frame < kFrames; ++frame) {
    const Sums bias_v = with_history(states, sequences, frame, p.A, p.a, p.shape.order);
    const Sums bias_h = with_history(states, sequences, frame, p.B, p.b, p.shape.order);
    const auto bound_of = [&](const MatrixD& magnitude) {
      return MatrixD((0.25 * gamma_n(terms) * magnitude).array() + kSigmoidError * kRoundoff);
    };
    MatrixD h = at_frame(code, sequences, frame);
    Eigen::ArrayXd closest = Eigen::ArrayXd::Ones(h.rows());  // |p − u| less its bound
    RandomKey key{options.seed, static_cast<std::uint32_t>(frame), kStream, 0};
    const auto draw = [&](const MatrixD& probability, const MatrixD& bound) {
      const MatrixD u = uniforms(key, probability.rows(), probability.cols());
      ++key.phase;
      closest = closest.min(((probability - u).cwiseAbs() - bound).rowwise().minCoeff().array());
      return reference::bernoulli(probability, u);
    };
    for (std::size_t k = 0; k < options.sampling.gibbs_steps; ++k) {
      const MatrixD v = draw(reference::sigmoid(MatrixD(bias_v.value + h * W.transpose())),
                             bound_of(bias_v.magnitude + h * W.cwiseAbs().transpose()));
      h = draw(reference::sigmoid(MatrixD(bias_h.value + v * W)),
               bound_of(bias_h.magnitude + v * W.cwiseAbs()));
    }
    const MatrixD want = reference::sigmoid(MatrixD(bias_v.value + h * W.transpose()));
    const MatrixD bound = bound_of(bias_v.magnitude + h * W.cwiseAbs().transpose());
    const MatrixD got = at_frame(states, sequences, frame);
    for (Eigen::Index i = 0; i < want.rows(); ++i) {
      if (!(closest(i) > 0)) continue;
      ++counted;
      CAPTURE(frame);
      CHECK(misfit(got.row(i), want.row(i), bound.row(i)) == "");
    }
  }
  return counted;
}

struct Case {
  CrbmShape shape;
  std::size_t sequences;
};

}  // namespace

TEST_CASE("decoder: every frame's means are the reference's, fused and frame by frame") {
  on_every_device([](Device& device) {
    for (const auto& [shape, sequences] :
         {Case{{1, 1, 1, kGaussian}, 1}, Case{{7, 5, 5, kBinary}, 3},
          Case{{33, 19, 2, kGaussian}, 11}})
      for (const bool fused : {true, false}) {
        CAPTURE(shape.visible);
        CAPTURE(fused);
        const CrbmParameters p = parameters_of(shape, 3);
        const MatrixF code = random_code(sequences * kFrames, shape.hidden);
        const auto before = device.launch_count();
        const MatrixF states = decoded(device, {p}, code, sequences, {}, fused);
        if (fused) CHECK(device.launch_count() - before <= sequences + 2);
        check_means(states, code, p, sequences, shape.order);
        // What stood before is history and stays.
        CHECK(states.topRows(shape.order) == p.visible_mean.replicate(shape.order, 1));
      }
  });
}

TEST_CASE("decoder: a lower layer follows the means of the one above") {
  on_every_device([](Device& device) {
    const CrbmParameters low = parameters_of({13, 9, 3, kGaussian}, 5);
    const CrbmParameters top = parameters_of({9, 21, 3, kBinary}, 25);
    const std::size_t sequences = 5;
    const MatrixF code = random_code(sequences * kFrames, 21);
    for (const bool fused : {true, false}) {
      CAPTURE(fused);
      const MatrixF above = decoded(device, {top}, code, sequences, {}, fused);
      check_means(decoded(device, {low, top}, code, sequences, {}, fused), above, low, sequences,
                  3);
    }
  });
}

TEST_CASE("decoder: sampled frames are the reference's with the same draws") {
  on_every_device([](Device& device) {
    RegenerationOptions options;
    options.temperature = 1.0;
    options.seed = 7;
    for (const auto& [shape, sequences] :
         {Case{{1, 1, 1, kBinary}, 1}, Case{{7, 13, 5, kBinary}, 3},
          Case{{19, 33, 2, kBinary}, 11}}) {
      CAPTURE(shape.visible);
      const CrbmParameters p = parameters_of(shape, 3);
      const MatrixF code = random_code(sequences * kFrames, shape.hidden);
      const MatrixF states = decoded(device, {p}, code, sequences, options);
      CHECK(2 * check_samples(states, code, p, sequences, options) >
            sequences * (kFrames - shape.order));
      CHECK(decoded(device, {p}, code, sequences, options) == states);
      options.seed = 8;
      CHECK(decoded(device, {p}, code, sequences, options) != states);
      options.seed = 7;
    }
  });
}

TEST_CASE("decoder: a temperature between 0 and 1 draws as frame by frame does") {
  on_every_device([](Device& device) {
    RegenerationOptions options;
    options.temperature = 0.5;
    options.sampling.gibbs_steps = 1;
    const CrbmParameters p = parameters_of({7, 13, 1, kBinary}, 3);
    const MatrixF code = random_code(kFrames, 13);
    const MatrixF fused = decoded(device, {p}, code, 1, options);
    const MatrixF frame_by_frame = decoded(device, {p}, code, 1, options, false);
    // Sums of some forty terms below one, through sigmoids of slope ¼, over twelve frames.
    const MatrixD bound = MatrixD::Constant(fused.rows(), fused.cols(), kFrames * gamma_n(100));
    CHECK(misfit(fused, frame_by_frame.cast<double>(), bound) == "");
    CHECK(fused != decoded(device, {p}, code, 1, {}));
  });
}
