// What the sampled clamped chain draws, against a tiny MRBM whose states can all be counted.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/mrbm_chain.hpp"
#include "machines/two_modalities.hpp"
#include "reference/mrbm_chain_reference.hpp"

namespace mrbm_chain_statistics_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kTrack = 3, kPose = 4, kHidden = 3, kRows = 40'000;

const MrbmParameters& parameters() {
  // Weights so large that the first step's distribution is not the stationary one.
  static const MrbmParameters drawn = mrbm_of(
      {random_matrix(kTrack, kHidden, 1, 2.0F), random_matrix(kPose, kHidden, 2, 3.0F)},
      {random_matrix(1, kTrack, 3), random_matrix(1, kPose, 4)}, random_matrix(1, kHidden, 5));
  return drawn;
}

reference::Mrbm model() {
  const MrbmParameters& p = parameters();
  return {{p.W[0].cast<double>(), p.W[1].cast<double>()},
          {p.a[0].cast<double>(), p.a[1].cast<double>()},
          p.b.cast<double>()};
}

/// Shares of the hidden states, each row's inferred from its p(absent | h), which differ by state.
RowVectorD hidden_shares(const MatrixF& absent, const reference::HiddenStates& states) {
  RowVectorD shares = RowVectorD::Zero(states.absent.rows());
  for (Eigen::Index r = 0; r < absent.rows(); ++r) {
    Eigen::Index state = 0;
    const double distance = (states.absent.rowwise() - RowVectorD(absent.row(r).cast<double>()))
                                .cwiseAbs()
                                .rowwise()
                                .maxCoeff()
                                .minCoeff(&state);
    REQUIRE(distance < 1e-5);
    shares(state) += 1.0 / static_cast<double>(absent.rows());
  }
  return shares;
}

/// What Σ|share − p| of n independent draws stays below but for one time in 10⁹ (Weissman et al.
/// 2003): P(Σ ≥ ε) ≤ (2^states − 2) · exp(−n·ε²/2).
double share_bound(Eigen::Index states) {
  const double ways = std::exp2(static_cast<double>(states)) - 2.0;
  return std::sqrt(2.0 * std::log(ways * 1e9) / static_cast<double>(kRows));
}

/// The mean of numbers in [0, 1], with the same certainty for all units (Hoeffding).
double mean_bound(Eigen::Index units) {
  return std::sqrt(std::log(2.0 * static_cast<double>(units) * 1e9) /
                   (2.0 * static_cast<double>(kRows)));
}

double distance(const RowVectorD& x, const RowVectorD& y) {
  return (x - y).cwiseAbs().sum();
}

}  // namespace

TEST_CASE("enumeration: p(h | present) is what the clamped chain leaves as it is") {
  for (const int present : {0, 1}) {
    const RowVectorD values = RowVectorD::Constant(present == 0 ? kTrack : kPose, 0.7);
    const auto states = reference::enumerate_hidden(model(), present, values);
    CHECK(std::abs(states.stationary.sum() - 1.0) < 1e-12);
    CHECK((states.transition.rowwise().sum().array() - 1.0).abs().maxCoeff() < 1e-12);
    CHECK(distance(states.stationary * states.transition, states.stationary) < 1e-12);
  }
}

TEST_CASE("the sampled clamped chain's states are distributed as enumeration gives") {
  for (const std::size_t present : {modality::track, modality::pose}) {
    const std::size_t units = present == modality::track ? kTrack : kPose;
    const MatrixF row = (0.5F * (random_matrix(1, units, 6).array() + 1.0F)).matrix();
    const auto states =
        reference::enumerate_hidden(model(), static_cast<int>(present), row.cast<double>());
    const double bound = share_bound(states.start.size());
    REQUIRE(distance(states.start, states.stationary) > 4.0 * bound);  // else k would not matter
    on_every_device([&](Device& device) {
      const Mrbm mrbm(device, parameters());
      const Matrix codes = Matrix::filled_with_row(Matrix::from_host(device, row), kRows);
      const Matrix absent(device, kRows, mrbm.visible(other(present)));
      MrbmChain chain(mrbm, only(present), kRows);
      RowVectorD want = states.start;
      for (std::size_t steps = 1; steps <= 40; ++steps, want = want * states.transition) {
        if (steps > 2 && steps < 40) continue;
        CAPTURE(steps);
        const RandomKey key{11, static_cast<std::uint32_t>(steps), 1, 0};
        chain.run(in_order(present, codes, absent),
                  {.steps = steps, .temperature = 1.0F, .random = key});
        const MatrixF got = absent.to_host();
        const RowVectorD shares = hidden_shares(got, states);
        CHECK(distance(shares, want) < bound);
        const RowVectorD mean = got.cast<double>().colwise().mean();
        CHECK((mean - want * states.absent).cwiseAbs().maxCoeff() < mean_bound(mean.size()));
        if (steps < 40) continue;
        CHECK(distance(want, states.stationary) < 1e-2 * bound);  // settled
        CHECK(distance(shares, states.stationary) < 1.01 * bound);
      }
    });
  }
}

}  // namespace mrbm_chain_statistics_test
