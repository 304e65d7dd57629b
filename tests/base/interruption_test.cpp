#include "base/interruption.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <stdexcept>

using namespace mcdbn;

TEST_CASE("a call that runs interruptibly releases what it holds before it returns or throws") {
  constexpr int kOften = 2000;  // a late release is late now and then
  const auto held = std::make_shared<int>(0);
  for (int i = 0; i < kOften; ++i) {
    run_interruptibly([held] { ++*held; });
    REQUIRE(held.use_count() == 1);
    CHECK_THROWS_AS(run_interruptibly([held] { throw std::runtime_error("its own"); }),
                    std::runtime_error);
    REQUIRE(held.use_count() == 1);
  }
  CHECK(*held == kOften);
}
