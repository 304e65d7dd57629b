// The down-pass of a stack whose top layer is Gaussian, as the only layer of the default model is,
// against double precision with draws of its own.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/random_crbm.hpp"
#include "machines/regeneration_reference.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"

namespace gaussian_decoder_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::misfit;

namespace {

constexpr std::size_t kFrames = 12, kFirst = 4, kLast = 11;

CrbmParameters layer(const CrbmShape& shape, unsigned seed) {
  return random_crbm(shape, seed, 2.0F);
}

struct Case {
  std::vector<CrbmParameters> layers;
  std::size_t sequences;
  MatrixF code;  ///< [sequences·frames x units], one sequence after another

  Case(std::vector<CrbmParameters> stack, std::size_t count)
      : layers(std::move(stack)),
        sequences(count),
        code(
            (0.5F * (random_matrix(count * kFrames, layers.back().shape.hidden, 99).array() + 1.0F))
                .matrix()) {}

  /// Sequence i's frame t is row i · frames + t.
  MatrixF at(const MatrixF& all, std::size_t t) const {
    MatrixF rows(sequences, all.cols());
    for (std::size_t i = 0; i < sequences; ++i)
      rows.row(static_cast<Eigen::Index>(i)) = all.row(static_cast<Eigen::Index>(i * kFrames + t));
    return rows;
  }
};

/// A single layer, one with as many units on either side, one below a stack, more sequences than a
/// block of rows.
std::vector<Case> cases() {
  const VisibleKind gaussian = VisibleKind::gaussian;
  return {{{layer({1, 1, 1, gaussian}, 1)}, 1},
          {{layer({6, 6, 2, gaussian}, 10)}, 3},
          {{layer({7, 13, 4, gaussian}, 20)}, 11},
          {{layer({5, 6, 1, gaussian}, 30), layer({6, 4, 3, gaussian}, 40)}, 5}};
}

MatrixF decoded(Device& device, const Case& test, const RegenerationOptions& options, bool fused) {
  Cdbn cdbn;
  for (const CrbmParameters& p : test.layers) cdbn.layers.emplace_back(device, p);
  const Matrix code = Matrix::from_host(device, test.code);
  CdbnDecoder decoder(cdbn, code, test.sequences);
  decoder.decode(kFirst, kLast, options, fused);
  return decoder.visible().to_host();
}

/// @return the share of the rows in which no draw lies so near that rounding may decide it
double check(const Case& test, const MatrixF& got, const RegenerationOptions& options) {
  reference::Frames code;
  for (std::size_t t = 0; t < kFrames; ++t)
    code.push_back(Bounded::exact(test.at(test.code, t).cast<double>()));
  const reference::DrawRule rule{options.temperature * options.sampling.scale,
                                 options.sampling.gibbs_steps, 0, false, options.seed};
  const auto want = reference::decoded(test.layers, code, kFirst, kLast, rule);
  std::size_t checked = 0, rows = 0;
  for (std::size_t t = 0; t < kFrames; ++t)
    for (Eigen::Index i = 0; i < want[t].value.rows(); ++i, ++rows) {
      if (!(want[t].bound.row(i).maxCoeff() < 1e-3)) continue;
      ++checked;
      CAPTURE(t);
      CAPTURE(i);
      CHECK(misfit(test.at(got, t).row(i), want[t].value.row(i), want[t].bound.row(i)) == "");
    }
  return static_cast<double>(checked) / static_cast<double>(rows);
}

}  // namespace

TEST_CASE("decoder: a Gaussian top layer's samples are the reference's with the same draws") {
  const auto tests = cases();
  on_every_device([&](Device& device) {
    for (const Case& test : tests)
      for (const std::size_t steps : {1U, 2U, 3U})
        for (const double temperature : {1.0, 0.4}) {
          INFO(test.layers.size(), " layers, ", test.sequences, " sequences, k = ", steps,
               ", temperature ", temperature);
          RegenerationOptions options;
          options.temperature = temperature;
          options.sampling.gibbs_steps = steps;
          options.sampling.scale = 0.75;
          options.seed = 0x123456789ULL + steps;
          for (const bool fused : {true, false})
            CHECK(check(test, decoded(device, test, options, fused), options) > 0.8);
        }
  });
}

TEST_CASE("decoder: a Gaussian top layer's mean field is the reference's, and draws nothing") {
  const auto tests = cases();
  on_every_device([&](Device& device) {
    for (const Case& test : tests)
      for (const bool fused : {true, false}) {
        RegenerationOptions mean_field;
        const MatrixF means = decoded(device, test, mean_field, fused);
        CHECK(check(test, means, mean_field) == 1.0);
        // Neither a temperature without steps nor steps without a temperature draw anything, and
        // neither does a scale of nothing.
        RegenerationOptions no_steps;
        no_steps.temperature = 1.0;
        no_steps.sampling.gibbs_steps = 0;
        CHECK(decoded(device, test, no_steps, fused) == means);
        RegenerationOptions no_scale;
        no_scale.temperature = 1.0;
        no_scale.sampling.scale = 0.0;
        CHECK(decoded(device, test, no_scale, fused) == means);
      }
  });
}

TEST_CASE("decoder: a code that does not fit, and a start without a history, are refused") {
  const Case test({layer({6, 6, 2, VisibleKind::gaussian}, 10)}, 3);
  on_every_device([&](Device& device) {
    Cdbn cdbn;
    cdbn.layers.emplace_back(device, test.layers[0]);
    const Matrix code = Matrix::from_host(device, test.code);
    CHECK_THROWS_AS(CdbnDecoder(cdbn, code, 0), ShapeError);
    CHECK_THROWS_AS(CdbnDecoder(cdbn, code, 5), ShapeError);  // 36 rows
    const Matrix narrow(device, 36, 5);
    CHECK_THROWS_AS(CdbnDecoder(cdbn, narrow, 3), ShapeError);
    CdbnDecoder decoder(cdbn, code, 3);
    CHECK_THROWS_AS(decoder.decode(1, kFrames, {}), ShapeError);
    decoder.decode(2, 1000, {});  // ends with the code
    const MatrixF all = decoder.visible().to_host();
    decoder.decode(2, kFrames, {});
    CHECK(decoder.visible().to_host() == all);
    CHECK(all.allFinite());
    CHECK((all.row(kFrames - 1) - test.layers[0].visible_mean).cwiseAbs().maxCoeff() > 1e-3F);
  });
}

}  // namespace gaussian_decoder_test
