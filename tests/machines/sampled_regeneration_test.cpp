// Algorithms 3 and 5 with every option, against double precision with the same draws.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/drawn_frames.hpp"
#include "machines/random_crbm.hpp"
#include "machines/regeneration_reference.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace sampled_regeneration_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

MrbmParameters mrbm(std::size_t track, std::size_t pose, std::size_t hidden) {
  return mrbm_of({random_matrix(track, hidden, 50, 2.0F), random_matrix(pose, hidden, 51, 2.0F)},
                 {random_matrix(1, track, 52), random_matrix(1, pose, 53)},
                 random_matrix(1, hidden, 54));
}

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

/// Codes of equal size, so that one modality's in the other's place would fit. The 2D stack needs
/// three frames before its first code, a layer of the 3D stack four.
reference::Network two_layers() {
  return {{random_layer(6, 5, 2, kGaussian, 10), random_layer(5, 5, 1, kBinary, 20)},
          {random_layer(6, 5, 2, kGaussian, 30), random_layer(5, 5, 4, kBinary, 40)},
          mrbm(5, 5, 4),
          2,
          3};
}

/// A single layer, as the default model has; here the 2D stack needs more frames than the 3D one.
reference::Network one_layer() {
  return {{random_layer(6, 7, 3, kGaussian, 60)},
          {random_layer(9, 5, 1, kGaussian, 70)},
          mrbm(7, 5, 8),
          1,
          4};
}

Mcdbn on(Device& device, const reference::Network& network) {
  Cdbn track, pose;
  for (const auto& p : network.track) track.layers.emplace_back(device, p);
  for (const auto& p : network.pose) pose.layers.emplace_back(device, p);
  return {{std::move(track), std::move(pose)},
          Mrbm(device, network.mrbm),
          network.look_ahead,
          network.mean_field_steps};
}

std::vector<MatrixF> tracks() {
  return {random_matrix(7, 6, 1), random_matrix(3, 6, 2), random_matrix(1, 6, 3)};
}

reference::DrawRule rule_of(const RegenerationOptions& options) {
  return {options.temperature * options.sampling.scale, options.sampling.gibbs_steps,
          options.sampling.mrbm_gibbs_steps, options.sampling.steady, options.seed};
}

/// @return the share of the frames in which no draw lies so near that rounding may decide it
double check(Device& device, const reference::Network& network,
             const RegenerationOptions& options) {
  const auto want =
      reference::regenerated(network, tracks(), options.samples, options.run_in, rule_of(options));
  const auto got = regenerate(on(device, network), tracks(), options);
  return check_drawn(got, want);
}

RegenerationOptions options_with(const SamplingRule& sampling, double temperature) {
  RegenerationOptions options;
  options.samples = 3;
  options.temperature = temperature;
  options.sampling = sampling;
  options.seed = 0x5EED00000007ULL;  // more than 32 bits
  options.run_in = 2;
  return options;
}

}  // namespace

TEST_CASE("regeneration: what options are unless they are given") {
  const RegenerationOptions options;
  CHECK(options.samples == 1);
  CHECK(options.temperature == 0.0);
  CHECK(options.seed == 1);
  CHECK(options.run_in == 30);
  CHECK(options.sampling.gibbs_steps == 1);
  CHECK(options.sampling.mrbm_gibbs_steps == 0);
  CHECK_FALSE(options.sampling.steady);
  CHECK(options.sampling.scale == 1.0);
  RegenerationOptions drawn;
  drawn.temperature = 0.5;
  drawn.sampling.scale = 0.25;
  CHECK(drawn.drawn_share() == 0.125);
  const reference::Network network = one_layer();
  on_every_device([&](Device& device) {
    CHECK(check(device, network, {}) == 1.0);
    const Mcdbn machine = on(device, network);
    const MatrixF single = single_answer(machine, tracks()[0]);
    CHECK(single == regenerate(machine, {tracks()[0]})[0]);
  });
}

TEST_CASE("regeneration: samples of the decoder's own steps are the reference's") {
  on_every_device([](Device& device) {
    for (const auto& network : {two_layers(), one_layer()})
      for (const std::size_t steps : {1U, 3U})
        for (const double temperature : {1.0, 0.5}) {
          CAPTURE(steps);
          CAPTURE(temperature);
          const auto options = options_with({.gibbs_steps = steps, .scale = 0.8}, temperature);
          CHECK(check(device, network, options) > 0.5);
        }
  });
}

TEST_CASE("regeneration: samples of the MRBM's own chain are the reference's, steady or anew") {
  on_every_device([](Device& device) {
    for (const auto& network : {two_layers(), one_layer()})
      for (const std::size_t steps : {1U, 3U})
        for (const bool steady : {true, false}) {
          CAPTURE(steps);
          CAPTURE(steady);
          const auto options = options_with(
              {.gibbs_steps = 0, .mrbm_gibbs_steps = steps, .steady = steady, .scale = 1.5}, 0.5);
          CHECK(check(device, network, options) > 0.5);
        }
  });
}

TEST_CASE("regeneration: both chains at once, without a run-in, without a look-ahead") {
  on_every_device([](Device& device) {
    for (reference::Network network : {two_layers(), one_layer()}) {
      auto options = options_with(
          {.gibbs_steps = 2, .mrbm_gibbs_steps = 2, .steady = true, .scale = 1.0}, 0.7);
      CHECK(check(device, network, options) > 0.5);
      options.run_in = 0;
      CHECK(check(device, network, options) > 0.5);
      network.look_ahead = 0;
      CHECK(check(device, network, options) > 0.5);
      network.look_ahead = 9;  // further than any track is long
      CHECK(check(device, network, options) > 0.5);
    }
  });
}

TEST_CASE("regeneration: without a temperature the sampling rule has no effect") {
  const reference::Network network = two_layers();
  on_every_device([&](Device& device) {
    auto options =
        options_with({.gibbs_steps = 2, .mrbm_gibbs_steps = 2, .steady = true, .scale = 1.0}, 0.0);
    CHECK(check(device, network, options) == 1.0);
    const Mcdbn machine = on(device, network);
    const auto single = regenerate(machine, tracks());
    options.run_in = 30;
    const auto copies = regenerate(machine, tracks(), options);
    REQUIRE(copies.size() == 9);
    for (std::size_t i = 0; i < 9; ++i)
      CHECK((copies[i] - single[i / 3]).cwiseAbs().maxCoeff() < 1e-5F);
    options.samples = 0;
    CHECK(regenerate(machine, tracks(), options).empty());
  });
}

}  // namespace sampled_regeneration_test
