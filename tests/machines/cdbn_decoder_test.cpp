#include "machines/cdbn_decoder.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/random_crbm.hpp"
#include "machines/regeneration_reference.hpp"
#include "reference/error_bounds.hpp"
#include "reference/running_error.hpp"

namespace cdbn_decoder_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::exact;
using reference::misfit;
using reference::Sum;

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

/// bias + Σ over the history of frame t, a row for each sequence. What the other layer adds goes
/// into the same sum.
Sum with_history(const MatrixF& states, std::size_t sequences, std::size_t frame,
                 const MatrixF& weights, const MatrixF& bias, std::size_t order) {
  const auto visible = states.cols();
  MatrixD history(sequences, static_cast<Eigen::Index>(order) * visible);
  for (std::size_t q = 0; q < order; ++q)
    history.middleCols(static_cast<Eigen::Index>(q) * visible, visible) =
        at_frame(states, sequences, frame - order + q);
  return Sum().add_product(Bounded::exact(history), exact(weights)).add_row(exact(bias));
}

/// Every frame of a layer from the device's own frames before it and what the layer above gave, so
/// that errors do not build up and one frame's bound is enough (Higham 3.5).
void check_means(const MatrixF& states, const MatrixF& above, const CrbmParameters& p,
                 std::size_t sequences, std::size_t first) {
  for (std::size_t frame = first; frame < kFrames; ++frame) {
    CAPTURE(frame);
    const Bounded code = Bounded::exact(at_frame(above, sequences, frame));
    Bounded want = with_history(states, sequences, frame, p.A, p.a, p.shape.order_A())
                       .add_product(code, exact(p.W).transposed())
                       .result();
    if (p.shape.kind == kBinary) want = sigmoid(want);
    CHECK(misfit(at_frame(states, sequences, frame), want.value, want.bound) == "");
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
  const Bounded W = exact(p.W);
  std::size_t counted = 0;
  for (std::size_t frame = p.shape.order; frame < kFrames; ++frame) {
    const Sum bias_v = with_history(states, sequences, frame, p.A, p.a, p.shape.order_A());
    const Sum bias_h = with_history(states, sequences, frame, p.B, p.b, p.shape.order_B());
    const auto below = [&](const Bounded& h) {
      return sigmoid(Sum(bias_v).add_product(h, W.transposed()).result());
    };
    Bounded h = Bounded::exact(at_frame(code, sequences, frame));
    Eigen::VectorXd doubtful_draws = Eigen::VectorXd::Zero(h.value.rows());
    RandomKey key{options.seed, static_cast<std::uint32_t>(frame), kStream, 0};
    const auto draw = [&](const Bounded& probability) {
      const MatrixD u = uniforms(key, probability.value.rows(), probability.value.cols());
      ++key.phase;
      const Bounded bits = bernoulli(probability, u);
      doubtful_draws += bits.bound.rowwise().sum();
      return Bounded::exact(bits.value);
    };
    for (std::size_t k = 0; k < options.sampling.gibbs_steps; ++k) {
      const Bounded v = draw(below(h));
      h = draw(sigmoid(Sum(bias_h).add_product(v, W).result()));
    }
    const Bounded want = below(h);
    const MatrixD got = at_frame(states, sequences, frame);
    for (Eigen::Index i = 0; i < got.rows(); ++i) {
      if (doubtful_draws(i) > 0) continue;
      ++counted;
      CAPTURE(frame);
      CHECK(misfit(got.row(i), want.value.row(i), want.bound.row(i)) == "");
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
          Case{{5, 7, 4, kBinary, 2, 4}, 3}, Case{{9, 3, 3, kGaussian, 3, 0}, 2},
          Case{{33, 19, 2, kGaussian}, 11}})
      for (const bool fused : {true, false}) {
        const std::size_t visible = shape.visible;
        CAPTURE(visible);
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
          Case{{6, 9, 4, kBinary, 1, 4}, 3}, Case{{5, 11, 4, kBinary, 3, 2}, 2},
          Case{{19, 33, 2, kBinary}, 11}}) {
      const std::size_t visible = shape.visible;
      CAPTURE(visible);
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

TEST_CASE("small: work-items that share a block of sequences decode the same bits, drawn or not") {
  on_every_device([](Device& device) {
    const CrbmParameters p = parameters_of({7, 5, 3, kBinary}, 3);
    constexpr std::size_t kSequences = 4;
    const MatrixF code = random_code(kSequences * kFrames, 5);
    const Tuning usual = device.tuning();
    for (const double temperature : {0.0, 1.0}) {
      CAPTURE(temperature);
      RegenerationOptions options;
      options.temperature = temperature;
      const MatrixF want = decoded(device, {p}, code, kSequences, options);
      device.set_tuning({.vector_width = 4, .largest_rows = 3, .accumulators = 4, .group = 4});
      CHECK(decoded(device, {p}, code, kSequences, options) == want);
      device.set_tuning(usual);
      if (temperature == 0.0) check_means(want, code, p, kSequences, p.shape.order);
    }
  });
}

TEST_CASE("decoder: a temperature between 0 and 1 draws as the reference does") {
  const CrbmParameters p = parameters_of({7, 13, 1, kBinary}, 3);
  const MatrixF code = random_code(kFrames, 13);
  reference::Frames frames;
  for (std::size_t t = 0; t < kFrames; ++t) frames.push_back(Bounded::exact(at_frame(code, 1, t)));
  RegenerationOptions options;
  options.temperature = 0.5;
  options.sampling.gibbs_steps = 1;
  const reference::DrawRule rule{options.drawn_share(), 1, 0, false, options.seed};
  const auto want = reference::decoded({p}, frames, p.shape.order, kFrames, rule);
  on_every_device([&](Device& device) {
    for (const bool fused : {true, false}) {
      CAPTURE(fused);
      const MatrixF got = decoded(device, {p}, code, 1, options, fused);
      for (std::size_t t = 0; t < kFrames; ++t) {
        CAPTURE(t);
        REQUIRE(want[t].bound.maxCoeff() < 1e-4);  // no draw that rounding decides
        CHECK(misfit(at_frame(got, 1, t), want[t].value, want[t].bound) == "");
      }
      CHECK(got != decoded(device, {p}, code, 1, {}));
    }
  });
}

}  // namespace cdbn_decoder_test
