#pragma once

#include "features/clip_modalities.hpp"
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

}  // namespace mcdbn::test
