// The bimodal autoencoder's pass and gradient against double precision.

#include "comparison/bimodal_network.hpp"

#include <doctest/doctest.h>

#include "comparison/bimodal_reference.hpp"
#include "comparison/clips.hpp"
#include "device/every_device.hpp"

namespace bimodal_network_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const BimodalShape kShape{{7, 3}, {5, 4}, 6};

std::vector<DenseLayer> some_layers() {
  std::vector<DenseLayer> layers;
  const std::array<std::pair<int, int>, 8> sizes = {
      {{7, 5}, {3, 4}, {5, 6}, {4, 6}, {6, 5}, {6, 4}, {5, 7}, {4, 3}}};
  unsigned seed = 10;
  for (const auto& [rows, columns] : sizes) {
    layers.push_back({0.6F * random_clip(rows, columns, seed), random_clip(1, columns, seed + 1)});
    seed += 2;
  }
  return layers;
}

}  // namespace

TEST_CASE("bimodal network: its pass and its gradient are the reference's") {
  const std::array<MatrixF, 2> input = {random_clip(9, 7, 1), random_clip(9, 3, 2)};
  const std::array<MatrixF, 2> target = {random_clip(9, 7, 3), random_clip(9, 3, 4)};
  const std::array<double, 2> weight = {0.7, 2.5};
  const BimodalReference reference(some_layers());
  const auto want = reference.pass({input[0].cast<double>(), input[1].cast<double>()});
  const auto gradient =
      reference.gradient({input[0].cast<double>(), input[1].cast<double>()},
                         {target[0].cast<double>(), target[1].cast<double>()}, weight);
  on_every_device([&](Device& device) {
    BimodalNetwork network(device, kShape, some_layers());
    BimodalNetwork::Pass pass(device, kShape, 9), errors(device, kShape, 9);
    for (std::size_t m = 0; m < 2; ++m) pass.input[m].upload(input[m]);
    network.forward(pass);
    network.differentiate(
        pass, {Matrix::from_host(device, target[0]), Matrix::from_host(device, target[1])},
        {0.7F, 2.5F}, errors);
    // A dozen terms of size 1 to each of five layers: rounding is some 1e-6.
    for (std::size_t m = 0; m < 2; ++m)
      CHECK((pass.output[m].to_host().cast<double>() - want.output[m]).cwiseAbs().maxCoeff() <
            2e-5);
    const std::vector<DenseLayer> got = network.layers().gradients();
    REQUIRE(got.size() == 8);
    for (std::size_t i = 0; i < 8; ++i) {
      CAPTURE(i);
      CHECK(gradient[i].W.cwiseAbs().maxCoeff() > 1e-3);
      CHECK((got[i].W.cast<double>() - gradient[i].W).cwiseAbs().maxCoeff() < 2e-5);
      CHECK((got[i].b.cast<double>() - gradient[i].b).cwiseAbs().maxCoeff() < 2e-5);
    }
  });
}

TEST_CASE("bimodal network: the reference's gradient is that of finite differences") {
  const std::array<MatrixD, 2> input = {random_clip(5, 7, 1).cast<double>(),
                                        random_clip(5, 3, 2).cast<double>()};
  const std::array<MatrixD, 2> target = {random_clip(5, 7, 3).cast<double>(),
                                         random_clip(5, 3, 4).cast<double>()};
  BimodalReference reference(some_layers());
  const auto gradient = reference.gradient(input, target, {0.7, 2.5});
  const auto check = [&](double& parameter, double slope) {
    const double kept = parameter, step = 1e-5;
    parameter = kept + step;
    const double up = reference.loss(input, target, {0.7, 2.5});
    parameter = kept - step;
    const double down = reference.loss(input, target, {0.7, 2.5});
    parameter = kept;
    CHECK(std::abs((up - down) / (2 * step) - slope) < 1e-7);
  };
  for (std::size_t i = 0; i < 8; ++i) {
    CAPTURE(i);
    for (Eigen::Index k = 0; k < gradient[i].W.size(); k += 3)
      check(reference.layers[i].W.data()[k], gradient[i].W.data()[k]);
    for (Eigen::Index k = 0; k < gradient[i].b.size(); ++k)
      check(reference.layers[i].b.data()[k], gradient[i].b.data()[k]);
  }
}

}  // namespace bimodal_network_test
