#include "device/row_tile.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

/// Blocks are dealt out whole: what counts is how long the busiest compute unit works. A block
/// costs its rows plus what does not depend on them (loading weights, launching): timed alone, a
/// block of the Gaussian chain costs as much as 3 rows more, but whole mini-batches of 100 and 1024
/// take as long with 3 as with 1.5, which lets the blocks of 10 rows sum two columns of vectors at
/// once.
double busiest_unit_cost(std::size_t batch, std::size_t rows, std::size_t units) {
  constexpr double kBlockOverheadRows = 1.5;
  const std::size_t blocks = ceil_divide(ceil_divide(batch, rows), units);
  return static_cast<double>(blocks) * (static_cast<double>(rows) + kBlockOverheadRows);
}

/// On a CPU a panel of 24 rows: what it reads of the other factor serves three tiles of 8 rows.
int panel_tiles(const RowTile& tile) {
  constexpr int kPanelRows = 24;
  const int wanted = tile.group == 1 ? std::max(1, kPanelRows / tile.update_rows) : 1;
  return std::min(wanted, tile.most_panel_tiles);
}

/// Tiles of so many rows whose panel, packed for both factors (weight_tile.clh), fits.
std::size_t fitting_panel_tiles(const DeviceInfo& info, int update_rows) {
  constexpr std::size_t kFactors = 2;
  return info.local_memory_bytes /
         (kFactors * kUpdateChunk * static_cast<std::size_t>(update_rows) * sizeof(float));
}

}  // namespace

std::optional<RowTile> choose_row_tile(const Device& device, std::size_t floats_per_row,
                                       std::size_t batch, const std::string& what) {
  const DeviceInfo& info = device.info();
  const std::size_t row_bytes = floats_per_row * sizeof(float);
  const std::size_t fitting = info.local_memory_bytes / std::max<std::size_t>(row_bytes, 1);
  constexpr int kFewestUpdateRows = 4;
  if (fitting == 0 || fitting_panel_tiles(info, kFewestUpdateRows) == 0) {
    spdlog::debug(
        "{}: one row takes {} bytes of local memory, the device has {}; composed kernels instead",
        what, row_bytes, info.local_memory_bytes);
    return std::nullopt;
  }
  const Tuning& tuning = device.tuning();
  RowTile tile;
  tile.vector_width = tuning.vector_width;
  tile.group = tuning.group;
  tile.update_rows = tuning.update_rows;
  while (fitting_panel_tiles(info, tile.update_rows) == 0) tile.update_rows /= 2;
  tile.update_columns = tuning.update_columns;
  tile.most_panel_tiles = static_cast<int>(std::min<std::size_t>(
      fitting_panel_tiles(info, tile.update_rows), RowTile{}.most_panel_tiles));
  const std::size_t largest =
      std::min({fitting, batch, static_cast<std::size_t>(tuning.largest_rows)});
  const std::size_t units = std::max(1U, info.compute_units);
  std::size_t best = std::max<std::size_t>(largest, 1);
  for (std::size_t rows = best; rows >= 1; --rows)
    if (busiest_unit_cost(batch, rows, units) < busiest_unit_cost(batch, best, units)) best = rows;
  tile.rows = to_int(best);
  // Few rows take more columns, so that enough fma() are under way and weights are read in longer
  // pieces.
  constexpr int kMostColumns = 8;
  tile.columns = std::clamp(tuning.accumulators / tile.rows, 1, kMostColumns);
  return tile;
}

Defines with_tile(Defines defines, const RowTile& tile) {
  defines["ROWS"] = tile.rows;
  defines["COLUMNS"] = tile.columns;
  defines["GROUP"] = tile.group;
  return defines;
}

Defines with_update_tile(Defines defines, const RowTile& tile) {
  defines["ROWS"] = tile.update_rows;
  defines["COLUMNS"] = tile.update_columns;
  defines["GROUP"] = tile.group;
  defines["PANEL_TILES"] = panel_tiles(tile);
  defines["CHUNK"] = to_int(kUpdateChunk);
  return defines;
}

std::size_t update_panels(const RowTile& tile, std::size_t rows) {
  return ceil_divide(rows, static_cast<std::size_t>(tile.update_rows * panel_tiles(tile)));
}

std::size_t whole_blocks(std::size_t batch, const std::optional<RowTile>& tile) {
  const auto rows = static_cast<std::size_t>(tile ? tile->rows : 1);
  return ceil_divide(batch, rows) * rows;
}

}  // namespace mcdbn
