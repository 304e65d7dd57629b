#pragma once

#include "mcdbn/formats/bvh.hpp"

namespace mcdbn::test {

/// Two seconds of a synthesized walk as version 0.1 made it: bounds on what the fit does to it do
/// not hang on what synthesis draws today.
inline Motion two_second_walk() {
  return read_bvh(MCDBN_SOURCE_DIR "/tests/fitting/walk.bvh");
}

}  // namespace mcdbn::test
