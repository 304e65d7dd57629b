#include "mcdbn/device/tuning.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"
#include "device/default_tuning.hpp"
#include "device/every_device.hpp"
#include "device/gemm.hpp"
#include "device/row_tile.hpp"

namespace tuning_test {

using namespace mcdbn;
using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// A user's cache folder of the test's own.
struct CacheFolder {
  ScratchFolder scratch;
  fs::path path = scratch / "cache";
  ScopedVariable variable{"XDG_CACHE_HOME", path.string()};
};

DeviceInfo some_device(std::string driver = {}) {
  DeviceInfo info;
  info.driver_version = std::move(driver);
  info.compute_units = 2;
  info.local_memory_bytes = 1 << 20;
  return info;
}

const Tuning kTuned{.vector_width = 8,
                    .largest_rows = 10,
                    .accumulators = 12,
                    .update_rows = 4,
                    .update_columns = 3,
                    .product_rows = 5,
                    .product_columns = 4,
                    .transposed_rows = 8,
                    .transposed_columns = 2,
                    .summed_rows = 64,
                    .unroll = 4,
                    .clblast_from = 1000};

}  // namespace

TEST_CASE("tuning: what was stored for a device is loaded, for that device only") {
  const CacheFolder folder;
  CHECK_FALSE(load_tuning(some_device()));
  store_tuning(some_device(), kTuned);
  CHECK(load_tuning(some_device()) == kTuned);
  CHECK_FALSE(load_tuning(some_device("2")));
}

TEST_CASE("tuning: no tile of a default wants more registers than a CPU has") {
  struct Registers {
    unsigned floats;
    int count, width;
  };
  for (const Registers& registers :
       {Registers{16, 32, 16}, Registers{8, 16, 8}, Registers{4, 16, 4}, Registers{1, 16, 1}}) {
    CAPTURE(registers.floats);
    const Tuning tuning = cpu_tuning(registers.floats);
    CHECK(tuning.vector_width == registers.width);
    // Sums, a vector of each column, a row's value.
    const auto fits = [&](int rows, int columns) {
      return (rows + 1) * columns + 1 <= registers.count;
    };
    CHECK(fits(tuning.largest_rows, tuning.accumulators / tuning.largest_rows));
    CHECK(fits(tuning.update_rows, tuning.update_columns));
    CHECK(fits(tuning.product_rows, tuning.product_columns));
    CHECK(fits(tuning.transposed_rows, tuning.transposed_columns));
  }
  const Tuning narrow = for_units_of_8_floats(cpu_tuning(16));
  CHECK(narrow.largest_rows == 10);
  CHECK(narrow.accumulators == 20);
}

TEST_CASE("tuning: a damaged or senseless entry is as none") {
  const CacheFolder folder;
  store_tuning(some_device(), kTuned);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path))
    if (entry.is_regular_file()) std::ofstream(entry.path(), std::ios::app) << "}";
  CHECK_FALSE(load_tuning(some_device()));
  Tuning senseless = kTuned;
  senseless.vector_width = 3;
  store_tuning(some_device(), senseless);
  CHECK_FALSE(load_tuning(some_device()));
  store_tuning(some_device(), kTuned);
  CHECK(load_tuning(some_device()) == kTuned);
}

TEST_CASE("tuning: an opened device has what was stored for it") {
  on_every_device([](Device& device) {
    const CacheFolder folder;  // not before: PoCL would keep its own kernels there from then on
    CHECK(Device(device.info()).tuning() == default_tuning(device.info()));
    store_tuning(device.info(), kTuned);
    CHECK(Device(device.info()).tuning() == kTuned);
  });
}

TEST_CASE("tuning: blocks of rows fill the compute units evenly and fit local memory") {
  on_every_device([](Device& device) {
    DeviceInfo info = device.info();
    if (info.is_gpu || info.compute_units != 2) return;
    CHECK(choose_row_tile(device, 400, 100, "test")->rows == 10);
    CHECK(choose_row_tile(device, 400, 1, "test")->rows == 1);
    const std::size_t floats = info.local_memory_bytes / sizeof(float);
    CHECK(choose_row_tile(device, floats / 3, 100, "test")->rows <= 3);
    CHECK_FALSE(choose_row_tile(device, floats + 1, 100, "test"));
  });
}

TEST_CASE("tuning: groups that a device does not take are made smaller, and CLBlast's left out") {
  DeviceInfo info = some_device();
  info.largest_group = 256;
  info.largest_group_sides[0] = info.largest_group_sides[1] = 256;
  Tuning tuning = kTuned;
  tuning.group = 64;
  CHECK(limited(tuning, info) == tuning);
  info.largest_group_sides[0] = 32;
  Tuning smaller = tuning;
  smaller.group = 32;
  smaller.clblast_from = 0;
  CHECK(limited(tuning, info) == smaller);
}

TEST_CASE("tuning: every candidate's products are the same bits as the default's, a GPU's too") {
  on_every_device([](Device& device) {
    const Matrix a = Matrix::from_host(device, random_matrix(13, 29, 1));
    const Matrix b = Matrix::from_host(device, random_matrix(29, 37, 2));
    const Tuning usual = device.tuning();
    const auto product = [&] {
      Matrix c(device, 13, 37);
      gemm(a, b, c);
      return c.to_host();
    };
    const MatrixF want = product();
    for (const bool is_gpu : {false, true}) {
      DeviceInfo info = device.info();
      info.is_gpu = is_gpu;
      for (const Tuning& tuning : tuning_candidates(info, default_tuning(info))) {
        device.set_tuning(tuning);
        CHECK(product() == want);
      }
    }
    device.set_tuning(usual);
  });
}

}  // namespace tuning_test
