#pragma once

#include <array>
#include <cstdint>

namespace mcdbn {

/// Names one family of draws: every (row, column) below it has its own Philox number, which is the
/// same on host, CPU and GPU (kernels/philox.clh defines how the counter is filled).
struct RandomKey {
  std::uint64_t seed = 0;
  std::uint32_t step = 0;    ///< mini-batch number, or frame
  std::uint16_t stream = 0;  ///< which layer, or what purpose
  std::uint16_t phase = 0;   ///< below 0x8000: Gibbs step and unit kind
};

/// Ten rounds of Philox4x32 (Salmon et al. 2011) on the host.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// The 32 bits that the kernels draw for that row and column.
std::uint32_t random_bits(const RandomKey& key, std::uint32_t row, std::uint32_t column);
/// random_bits() as a number in (0, 1).
float random_uniform(const RandomKey& key, std::uint32_t row, std::uint32_t column);
/// Standard normal, by Box-Muller in double precision.
double random_normal(const RandomKey& key, std::uint32_t row, std::uint32_t column);

}  // namespace mcdbn
