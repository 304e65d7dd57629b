#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace mcdbn {

struct DeviceInfo;
class Device;

/// How the kernels divide their work on a device. No choice changes what a kernel computes (sums
/// keep their order), only the time it takes; CLBlast's products may differ in the last bits.
struct Tuning {
  int vector_width = 16;    ///< floats that a work-item takes at once: 1, 4, 8 or 16
  int largest_rows = 14;    ///< of a block that a work-group carries through a fused chain
  int accumulators = 24;    ///< vectors that a work-item of a fused chain sums up at once, at most
  int group = 1;            ///< work-items that share a block of rows
  int update_rows = 16;     ///< rows of a gradient's tile: 4, 8 or 16
  int update_columns = 1;   ///< vectors of a row of that tile, 1 to 4
  int product_rows = 10;    ///< of a tile of A·B: enough to hide the fma latency, within registers
  int product_columns = 1;  ///< vectors of a row of that tile, 1 to 4
  int transposed_rows = 16;    ///< of a tile of Aᵀ·B; divides the column padding, so no row test
  int transposed_columns = 1;  ///< vectors of a row of that tile, 1 to 4
  /// Rows of A and B that Aᵀ·B sums in one go: their columns stay in a CPU's caches while the tiles
  /// of C read them again and again, which doubles the speed of sums over thousands of rows. 0:
  /// all.
  int summed_rows = 128;
  /// Rounds of a sum's loop that are made one (UNROLL in types.clh): a GPU has that many loads
  /// under way, where a single one is waited for. A CPU reads ahead by itself.
  int unroll = 1;
  /// Least number of multiply-adds of a product that goes to CLBlast; 0: none goes.
  std::int64_t clblast_from = 0;
  bool operator==(const Tuning&) const = default;
};

/// Tuning that suits most CPUs or GPUs.
Tuning default_tuning(const DeviceInfo& info);

/// `tuning` with no larger work-groups than the device takes, and without CLBlast where its groups
/// are larger.
Tuning limited(Tuning tuning, const DeviceInfo& info);

/// The default and its variants, one parameter changed in each: what a tuner tries and what the
/// kernel tests run with.
std::vector<Tuning> tuning_candidates(const DeviceInfo& info, const Tuning& from);

/// The winners as `mcdbn-cl bench --tune` left them in the user's cache folder; unset where there
/// is no entry for this device and driver, or one that makes no sense.
std::optional<Tuning> load_tuning(const DeviceInfo& info);
/// Keeps it there. @return whether it could be written
bool store_tuning(const DeviceInfo& info, const Tuning& tuning);

}  // namespace mcdbn
