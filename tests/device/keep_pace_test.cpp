#include <doctest/doctest.h>

#include "base/interruption.hpp"
#include "device/every_device.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

TEST_CASE("launches that go on and on stop when that is asked for, unless they must not") {
  constexpr int kMany = 1'000'000;
  test::on_every_device([&](Device& device) {
    const Matrix values(device, 16, 16);
    Matrix sum(device, 1, 16);
    const auto launch_many = [&](int count) {
      for (int i = 0; i < count; ++i) column_sum(values, 1.0F, 0.0F, sum);
    };
    launch_many(10);
    request_interruption();
    CHECK_THROWS_AS(launch_many(kMany), Interrupted);
    {
      const InterruptionDeferred deferred;
      CHECK_NOTHROW(check_interruption());
      CHECK(interruption_requested());
    }
    CHECK_THROWS_AS(check_interruption(), Interrupted);
    clear_interruption();
    CHECK_NOTHROW(check_interruption());
    CHECK_NOTHROW(launch_many(10));
  });
}
