#include "mcdbn/training/chain_tile.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "mcdbn/device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

/// Blocks are dealt out whole: what counts is how long the busiest compute unit works. A block
/// costs its rows plus what does not depend on them (loading weights, launching).
double busiest_unit_cost(std::size_t batch, std::size_t rows, std::size_t units) {
  constexpr double kBlockOverheadRows = 1.5;
  const std::size_t blocks = ceil_divide(ceil_divide(batch, rows), units);
  return static_cast<double>(blocks) * (static_cast<double>(rows) + kBlockOverheadRows);
}

}  // namespace

std::size_t chain_local_bytes(const CrbmShape& shape, const ChainTile& tile) {
  return static_cast<std::size_t>(tile.rows) * (padded(shape.visible) + padded(shape.hidden)) *
         sizeof(float);
}

std::size_t whole_blocks(std::size_t batch, const std::optional<ChainTile>& tile) {
  const auto rows = static_cast<std::size_t>(tile ? tile->rows : 1);
  return ceil_divide(batch, rows) * rows;
}

std::optional<ChainTile> choose_chain_tile(const Device& device, const CrbmShape& shape,
                                           std::size_t batch) {
  ChainTile best;
  best.vector_width = vector_width(device);
  if (device.info().is_gpu) best.group = 64;
  const int largest =
      std::min(device.info().is_gpu ? 4 : 14, to_int(std::max<std::size_t>(batch, 1)));
  const std::size_t units = std::max(1U, device.info().compute_units);
  double best_cost = 0;
  bool fits = false;
  for (int rows = largest; rows >= 1; --rows) {
    ChainTile tile = best;
    tile.rows = rows;
    if (chain_local_bytes(shape, tile) > device.info().local_memory_bytes) continue;
    const double cost = busiest_unit_cost(batch, static_cast<std::size_t>(rows), units);
    if (fits && cost >= best_cost) continue;
    fits = true;
    best = tile;
    best_cost = cost;
  }
  if (fits) return best;
  best.rows = 1;
  spdlog::debug(
      "{} visible, {} hidden units: one row of the fused Gibbs chain takes {} bytes of local "
      "memory, the device has {}; composed kernels instead",
      shape.visible, shape.hidden, chain_local_bytes(shape, best),
      device.info().local_memory_bytes);
  return std::nullopt;
}

}  // namespace mcdbn
