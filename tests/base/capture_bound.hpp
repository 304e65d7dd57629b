#pragma once

#include <doctest/doctest.h>

/// CAPTURE of a structured binding, which doctest's lambda cannot name with Clang 15.
#define CAPTURE_BOUND(binding)              \
  const auto& binding##_captured = binding; \
  INFO(#binding " := ", binding##_captured)
