#include "base/counted.hpp"

#include <doctest/doctest.h>

TEST_CASE("counted: one of them is one") {
  CHECK(mcdbn::counted(1, "frame") == "1 frame");
  CHECK(mcdbn::counted(0, "frame") == "0 frames");
  CHECK(mcdbn::counted(2L, "joint") == "2 joints");
}
