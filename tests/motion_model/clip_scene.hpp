#pragma once

#include <vector>

#include "base/random_matrix.hpp"
#include "features/clip_modalities.hpp"
#include "features/small_figure.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/device/matrix.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "motion/synthetic_motion.hpp"

namespace mcdbn::test {

/// A small network for them, its weights drawn: its answers depend on all that it sees.
inline Mcdbn random_network(Device& device, const Modalities& modalities) {
  const auto layer = [](int visible, std::size_t hidden, std::size_t order, std::uint64_t seed) {
    const CrbmShape shape{static_cast<std::size_t>(visible), hidden, order, VisibleKind::gaussian};
    return CrbmParameters::random(shape, 0.15, {seed, 0, 0, 0});
  };
  const MrbmParameters mrbm = MrbmParameters::random(two_modalities(8, 7, 6), 1.5, {3, 0, 0, 0});
  Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, mrbm), 2, 4};
  network.cdbns[0].layers.emplace_back(device,
                                       layer(modalities.track_scale.output_dimension(), 8, 2, 1));
  CrbmParameters pose = layer(modalities.pose_scale.output_dimension(), 7, 3, 2);
  pose.A *= 0.1F;  // else the history alone would drive it away
  network.cdbns[1].layers.emplace_back(device, pose);
  return network;
}

/// Tracks and poses of the small figure, standardized, which nothing but chance relates.
struct RandomClips {
  Modalities modalities = SmallFigure().modalities();
  std::vector<MatrixF> tracks, poses;

  explicit RandomClips(const std::vector<std::size_t>& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto seed = static_cast<unsigned>(i);
      tracks.push_back(random_matrix(frames[i], columns(modalities.track_scale), 10 + seed));
      poses.push_back(random_matrix(frames[i], columns(modalities.pose_scale), 20 + seed, 0.4F));
    }
  }
  static std::size_t columns(const Standardizer& scale) {
    return static_cast<std::size_t>(scale.output_dimension());
  }
};

}  // namespace mcdbn::test
