// The loops that measure a device's peaks do the work that is counted.
#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/kernel_arguments.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kItems = 3;
constexpr int kChains = 16, kIterations = 3;
constexpr int kRows = 2, kPasses = 3;

}  // namespace

TEST_CASE("small: the fma loop goes through all iterations of every chain") {
  on_every_device([](Device& device) {
    for (const int vec : {1, 4, 16}) {
      CAPTURE(vec);
      const Matrix out(device, 1, kItems);
      launch(device,
             device.programs().kernel("peak.cl", "fma_loop", {{"VEC", vec}, {"CHAINS", kChains}}),
             {{kItems, 1}, {1, 1}}, out.buffer(), kIterations, 0.5F, 1.0F);
      // x ← x/2 + 1, three times: x/8 + 7/4, exact in single precision.
      for (std::size_t item = 0; item < kItems; ++item) {
        double sum = 0;
        for (int chain = 0; chain < kChains; ++chain)
          sum += (static_cast<double>(item) + chain) / 8 + 1.75;
        CHECK(out.to_host()(0, static_cast<Eigen::Index>(item)) == vec * sum);
      }
    }
  });
}

TEST_CASE("small: the read loop reads each work-item's own rows, in every pass") {
  on_every_device([](Device& device) {
    for (const int vec : {1, 4, 16}) {
      CAPTURE(vec);
      const std::size_t row = 8 * static_cast<std::size_t>(vec);
      // Whole numbers: exact.
      const MatrixF values =
          (16.0F * random_matrix(kItems, kRows * row, 5).array()).round().matrix();
      const Matrix in = Matrix::from_host(device, values), out(device, 1, kItems);
      REQUIRE(in.stride() == kRows * row);
      launch(device, device.programs().kernel("peak.cl", "read_loop", {{"VEC", vec}}),
             {{kItems, 1}, {1, 1}}, in.buffer(), kRows, kPasses, out.buffer());
      for (std::size_t item = 0; item < kItems; ++item) {
        double first = 0, others = 0;
        for (int pass = 0; pass < kPasses; ++pass) {
          for (int r = 0; r < kRows; ++r)
            for (std::size_t c = 0; c < row; ++c) {
              const auto column = static_cast<Eigen::Index>(static_cast<std::size_t>(r) * row + c);
              const double value = values(static_cast<Eigen::Index>(item), column);
              (c < static_cast<std::size_t>(vec) ? first : others) += value;
            }
          first *= 0.5;
        }
        CHECK(out.to_host()(0, static_cast<Eigen::Index>(item)) == first + others);
      }
    }
  });
}
