#pragma once

namespace mcdbn {

/// How much a part of a series counts in its frame `t`, beside the part before it, whose last
/// `shared` frames are its first ones.
inline double fade_in(double t, double shared) {
  return t < shared ? (t + 1) / (shared + 1) : 1.0;
}

}  // namespace mcdbn
