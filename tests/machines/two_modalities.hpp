#pragma once

#include <vector>

#include "mcdbn/machines/mrbm.hpp"

/// What most tests join: a track and a pose, of binary units.
namespace mcdbn::test {

namespace modality {
constexpr std::size_t track = 0, pose = 1;
}

constexpr std::size_t other(std::size_t modality) {
  return 1 - modality;
}

inline MrbmShape two_modalities(std::size_t track, std::size_t pose, std::size_t hidden) {
  return {{{"track", track}, {"pose", pose}}, hidden};
}

/// @param W, a of the track and of the pose
inline MrbmParameters mrbm_of(std::vector<MatrixF> W, std::vector<MatrixF> a, MatrixF b) {
  const auto units = [](const MatrixF& row) { return static_cast<std::size_t>(row.cols()); };
  return {two_modalities(units(a[0]), units(a[1]), units(b)), std::move(W), std::move(a),
          std::move(b)};
}

/// For MrbmChain, of which one modality is present.
inline std::vector<bool> only(std::size_t present) {
  return {present == 0, present == 1};
}
inline std::vector<Rows> in_order(std::size_t present, const Rows& given, const Rows& absent) {
  return present == 0 ? std::vector<Rows>{given, absent} : std::vector<Rows>{absent, given};
}

}  // namespace mcdbn::test
